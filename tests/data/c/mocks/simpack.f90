! Stand-in for the module of Simpack: constants and access functions as a public user routine calls them.
module simpack
   implicit none
   integer, parameter :: MESSAGE_DIM = 200, MSG_FATAL = 3, fclass_force = 1, knodef = 0, knr_marker = 1, knr_double = 2
   integer, parameter :: kforce_res_force_torque = 3, kforce_strst_none = 0
   double precision :: given_place(3), given_axis(3), given_speed(3), given_turning(3)
   integer :: dimensions(3) = -1
contains
   subroutine spck_df_FClass(class, ierr)
      integer, intent(in) :: class
      integer, intent(out) :: ierr
      ierr = merge(0, 1, class == fclass_force)
   end subroutine
   subroutine spck_df_ForceParDim(n, ierr)
      integer, intent(in) :: n
      integer, intent(out) :: ierr
      dimensions(1) = n
      ierr = 0
   end subroutine
   subroutine spck_df_ForceStDynDim(n, ierr)
      integer, intent(in) :: n
      integer, intent(out) :: ierr
      dimensions(2) = n
      ierr = 0
   end subroutine
   subroutine spck_df_ForceOvDim(n, ierr)
      integer, intent(in) :: n
      integer, intent(out) :: ierr
      dimensions(3) = n
      ierr = 0
   end subroutine
   subroutine spck_av_dxyz(size, found, to, from, frame, ierr)
      double precision, intent(out) :: size, found(3)
      integer, intent(in) :: to, from, frame
      integer, intent(out) :: ierr
      ierr = 1
      if (frame == 21 .and. from == 21 .and. to == 22) ierr = 0
      if (frame == 21 .and. from == 22 .and. to == 23) ierr = 0
      found = merge(given_place, given_axis, from == 21)
      size = norm2(found)
   end subroutine
   subroutine spck_av_vxyz(size, along, found, to, from, observer, frame, ierr)
      double precision, intent(out) :: size, along, found(3)
      integer, intent(in) :: to, from, observer, frame
      integer, intent(out) :: ierr
      ierr = merge(0, 1, to == 22 .and. from == 21 .and. observer == 21 .and. frame == 21)
      found = given_speed
      size = norm2(given_speed)
      along = 0.0d0
   end subroutine
   subroutine spck_av_wxyz(size, found, to, from, frame, ierr)
      double precision, intent(out) :: size, found(3)
      integer, intent(in) :: to, from, frame
      integer, intent(out) :: ierr
      ierr = merge(0, 1, to == 22 .and. from == 21 .and. frame == 21)
      found = given_turning
      size = norm2(given_turning)
   end subroutine
   subroutine spck_uf_message(kind, text)
      integer, intent(in) :: kind
      character(len=*), intent(in) :: text
      print '(a,i0,1x,a)', 'message ', kind, trim(text)
   end subroutine
end module
