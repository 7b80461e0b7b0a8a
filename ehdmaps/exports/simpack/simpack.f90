! ----------------------------------------------------------------------------------------------------------------------
! User force element of Simpack (type 40): force and moment of a cylindrical roller bearing with films.
!
! From-marker: at the centre of the outer ring, in the housing. Its axes have to be parallel to those of its body's
! reference frame, in which Simpack takes forces, and its x axis is the axis of the bearing; it does not spin.
! To-marker: at the centre of the inner ring, on the shaft.
!
! Parameters: 1 marker on the axis of the shaft, away from its centre, that tells the direction of the axis; 2
! temperature of the raceways [K]; 3 diametral clearance [m]; 4: 1 if films have a memory, and go on with the steps of
! Simpack (film_history.h), 0 if they follow at once. First component of the u-vector: angle of the first roller
! from y towards z [rad] (turns of the inner ring times EHD_CAGE_INNER of ehd.h); without one the cage stands.
! Output values: 1 to 3 force, 4 to 6 moment on the inner ring in the frame of the from-marker [N], [N m]; 7 status of the
! law. Where the law refuses, a message says why and the element returns an error. Exported with --outside clamp or
! asymptote the law goes on there: output 7 is then not 0. Calls have to come from one thread.
!
! Interfaces after a public user routine (uforce40) and its access functions; no Simpack has run this.
! ----------------------------------------------------------------------------------------------------------------------
subroutine uforce40_type(str_dim, type_name, ierr)
   !DEC$ ATTRIBUTES DLLEXPORT :: uforce40_type
   use simpack
   implicit none
   integer, intent(in) :: str_dim
   character(len=*), intent(out) :: type_name
   integer, intent(out) :: ierr

   type_name = 'Roller bearing with films'
   call spck_df_FClass(fclass_force, ierr)
   if (ierr == 0) call spck_df_ForceParDim(4, ierr)
   if (ierr == 0) call spck_df_ForceStDynDim(0, ierr)
   if (ierr == 0) call spck_df_ForceOvDim(7, ierr)
end subroutine

subroutine uforce40_setup(task, par_dim, stdyn_dim, ov_dim, str_dim, id, mk_from, mk_to, par, par_type, par_name, &
                          par_unit, stdyn_name, stdyn_unit, ov_name, ov_unit, res_type, stdyn_nr, stroot_nr, &
                          strst_type, ierr)
   !DEC$ ATTRIBUTES DLLEXPORT :: uforce40_setup
   use simpack
   implicit none
   integer, intent(in) :: task, par_dim, stdyn_dim, ov_dim, str_dim, id, mk_from, mk_to
   double precision, intent(in out) :: par(par_dim)
   integer, intent(out) :: par_type(par_dim), par_unit(par_dim), stdyn_unit(stdyn_dim), ov_unit(ov_dim)
   character(len=*), intent(out) :: par_name(par_dim), stdyn_name(stdyn_dim), ov_name(ov_dim)
   integer, intent(out) :: res_type, strst_type, ierr
   integer :: stdyn_nr, stroot_nr

   ierr = 0
   if (task == 0) then
      par_name(1) = 'Marker on the axis'
      par_name(2) = 'Temperature [K]'
      par_name(3) = 'Diametral clearance [m]'
      par_name(4) = 'Films with memory (1) or slow (0)'
      par_type = [knr_marker, knr_double, knr_double, knr_double]
      par_unit = knodef
      stdyn_name = ' '
      stdyn_unit = knodef
      ov_name(1:3) = 'Force'
      ov_name(4:6) = 'Moment'
      ov_name(7) = 'Status'
      ov_unit = knodef
   else if (task == 1) then
      res_type = kforce_res_force_torque
      strst_type = kforce_strst_none
   end if
end subroutine

subroutine uforce40(task, par_dim, uin_dim, stdyn_dim, stroot_dim, ov_dim, id, par, mk_from, mk_to, time, uin, stdyn, &
                    stroot, stdynd, force, torque, ov, valroot, ierr)
   !DEC$ ATTRIBUTES DLLEXPORT :: uforce40
   use, intrinsic :: iso_c_binding
   use simpack
   implicit none
   integer, intent(in) :: task, par_dim, uin_dim, stdyn_dim, stroot_dim, ov_dim, id, mk_from, mk_to
   double precision, intent(in) :: par(par_dim), time, uin(uin_dim)
   double precision, intent(in out) :: stdyn(stdyn_dim)
   integer, intent(in out) :: stroot(stroot_dim)
   double precision, intent(out) :: stdynd(stdyn_dim), force(3), torque(3), ov(ov_dim), valroot(stroot_dim)
   integer, intent(out) :: ierr

   interface
      function bearing_slot(number, axis, place, speed, turning, cage_angle, T, clearance, found) bind(c)
         use, intrinsic :: iso_c_binding
         integer(c_int), value :: number
         real(c_double), intent(in) :: axis(3), place(3), speed(3), turning(3)
         real(c_double), value :: cage_angle, T, clearance
         real(c_double), intent(out) :: found(6)
         integer(c_int) :: bearing_slot
      end function
      function bearing_slot_memory(number, axis, place, turning, cage_angle, T, clearance, now, found) bind(c)
         use, intrinsic :: iso_c_binding
         integer(c_int), value :: number
         real(c_double), intent(in) :: axis(3), place(3), turning(3)
         real(c_double), value :: cage_angle, T, clearance, now
         real(c_double), intent(out) :: found(6)
         integer(c_int) :: bearing_slot_memory
      end function
   end interface

   double precision :: distance, along, axis(3), place(3), speed(3), turning(3), found(6), cage
   integer :: status
   character(len=MESSAGE_DIM) :: message

   ierr = 0
   force = 0.0d0
   torque = 0.0d0
   stdynd = 0.0d0
   valroot = 0.0d0
   if (task /= 0) return
   call spck_av_dxyz(distance, place, mk_to, mk_from, mk_from, ierr)
   if (ierr == 0) call spck_av_dxyz(distance, axis, nint(par(1)), mk_to, mk_from, ierr)
   if (ierr == 0) call spck_av_vxyz(distance, along, speed, mk_to, mk_from, mk_from, mk_from, ierr)
   if (ierr == 0) call spck_av_wxyz(distance, turning, mk_to, mk_from, mk_from, ierr)
   if (ierr /= 0) return
   cage = 0.0d0
   if (uin_dim > 0) cage = uin(1)
   if (par(4) /= 0.0d0) then
      status = bearing_slot_memory(id, axis, place, turning, cage, par(2), par(3), time, found)
   else
      status = bearing_slot(id, axis, place, speed, turning, cage, par(2), par(3), found)
   end if
   ov(1:6) = found
   ov(7) = status
   if (any(found /= found)) then
      write (message, '(a,i0,a,i0)') 'roller bearing with films, element ', id, ': outside of its map, status ', status
      call spck_uf_message(MSG_FATAL, message)
      ierr = 1
      return
   end if
   ! Simpack applies these at the from-marker, their opposites at the to-marker, and the moment of the distance itself.
   force = -found(1:3)
   torque = -found(4:6)
end subroutine
