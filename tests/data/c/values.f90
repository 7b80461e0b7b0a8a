! Prints the law and a bearing of an export at one point, with all digits.
program values
   use, intrinsic :: iso_c_binding
   use ehd
   implicit none
   integer(c_int64_t), allocatable, target :: law(:), bearing(:), film(:)
   type(ehd_force) :: force
   type(ehd_bearing_force) :: result
   type(ehd_film_state) :: before(12*41), after(12*41)
   type(ehd_film_rates) :: rates
   real(c_double) :: pose(6), velocity(6)
   integer(c_int) :: status
   allocate (law(ehd_prepared_size()/8 + 1), bearing(ehd_bearing_size()/8 + 1), &
             film(ehd_film_size()/8 + 1))
   law = 0
   film = 0
   pose = [0.0d0, 4.0d-6, -2.0d-6, 0.0d0, 1.0d-4, -2.0d-4]
   velocity = [0.0d0, 1.0d-4, 2.0d-4, 0.0d0, 0.0d0, 1.0d-3]
   status = ehd_law(2.0d-6, 1.0d-4, 1.0d0, 310.0d0, 0.0d0, force)
   print '(i0, 3es25.16e3)', status, force%load, force%stiffness, force%damping
   status = ehd_bearing_make(c_loc(bearing), 1.0d-5, 41, c_null_ptr)
   status = ehd_bearing_call(c_loc(bearing), c_loc(law), pose, velocity, 0.3d0, 1.0d0, 310.0d0, 0.0d0, result)
   print '(i0, 6es25.16e3)', status, result%force
   print '(12es25.16e3)', result%stiffness, result%damping
   status = ehd_film_at(c_loc(film), 1.0d0, 310.0d0)
   status = ehd_film_settled(c_loc(film), 2.0d-6, before(1))
   status = ehd_film_advance(c_loc(film), 1.0d-5, 0.0d0, 3.0d-6, before(1), after(1), force)
   print '(i0, 5es25.16e3)', status, after(1), force%load, force%stiffness
   status = ehd_film_rate(c_loc(film), 2.1d-6, 2.0d-6, rates)
   print '(i0, 6es25.16e3)', status, rates
   status = ehd_bearing_settled(c_loc(bearing), c_loc(film), pose, 0.3d0, before)
   pose(2) = 5.0d-6
   status = ehd_bearing_advance(c_loc(bearing), c_loc(film), 1.0d-5, 0.0d0, pose, 0.3d0, before, after, result)
   print '(i0, 6es25.16e3)', status, result%force
   print '(6es25.16e3)', result%stiffness
end program values
