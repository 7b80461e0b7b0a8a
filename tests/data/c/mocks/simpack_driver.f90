! Plays Simpack: motion of the markers in, force and moment at the from-marker out.
program driver
   use simpack
   implicit none
   double precision :: par(4), uin(1), kick, step, none(0), force(3), torque(3), ov(7)
   integer :: ierr, roots(0)
   character(len=40) :: name

   call uforce40_type(40, name, ierr)
   if (ierr /= 0 .or. any(dimensions /= [4, 0, 7])) stop 3
   par(1) = 23
   read *, given_place, given_axis, given_speed, given_turning, uin, par(2:4), kick, step
   call uforce40(0, 4, 1, 0, 0, 7, 5, par, 21, 22, 0.0d0, uin, none, roots, none, force, torque, ov, none, ierr)
   if (par(4) /= 0) then
      given_place(2) = given_place(2) + kick
      call uforce40(0, 4, 1, 0, 0, 7, 5, par, 21, 22, step, uin, none, roots, none, force, torque, ov, none, ierr)
      call uforce40(0, 4, 1, 0, 0, 7, 5, par, 21, 22, 2 * step, uin, none, roots, none, force, torque, ov, none, ierr)
   end if
   if (ierr == 0) print '(es25.17)', force, torque
end program
