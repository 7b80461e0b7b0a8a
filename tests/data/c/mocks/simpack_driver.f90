! Plays Simpack: motion of the markers in, force and moment at the from-marker out.
program driver
   use simpack
   implicit none
   double precision :: par(3), uin(1), none(0), force(3), torque(3), ov(7)
   integer :: ierr, roots(0)
   character(len=40) :: name

   call uforce40_type(40, name, ierr)
   if (ierr /= 0 .or. any(dimensions /= [3, 0, 7])) stop 3
   par(1) = 23
   read *, given_place, given_axis, given_speed, given_turning, uin, par(2:3)
   call uforce40(0, 3, 1, 0, 0, 7, 5, par, 21, 22, 0.0d0, uin, none, roots, none, force, torque, ov, none, ierr)
   if (ierr == 0) print '(es25.17)', force, torque
end program
