! Prints the law and a bearing of an export at one point, with all digits.
program values
   use, intrinsic :: iso_c_binding
   use ehd
   implicit none
   integer(c_int64_t), allocatable, target :: law(:), bearing(:)
   type(ehd_force) :: force
   type(ehd_bearing_force) :: result
   real(c_double) :: pose(6), velocity(6)
   integer(c_int) :: status
   allocate (law(ehd_prepared_size()/8 + 1), bearing(ehd_bearing_size()/8 + 1))
   law = 0
   pose = [0.0d0, 4.0d-6, -2.0d-6, 0.0d0, 1.0d-4, -2.0d-4]
   velocity = [0.0d0, 1.0d-4, 2.0d-4, 0.0d0, 0.0d0, 1.0d-3]
   status = ehd_law(2.0d-6, 1.0d-4, 1.0d0, 310.0d0, 0.0d0, force)
   print '(i0, 3es25.16e3)', status, force%load, force%stiffness, force%damping
   status = ehd_bearing_make(c_loc(bearing), 1.0d-5, 41, c_null_ptr)
   status = ehd_bearing_call(c_loc(bearing), c_loc(law), pose, velocity, 0.3d0, 1.0d0, 310.0d0, 0.0d0, result)
   print '(i0, 6es25.16e3)', status, result%force
   print '(12es25.16e3)', result%stiffness, result%damping
end program values
