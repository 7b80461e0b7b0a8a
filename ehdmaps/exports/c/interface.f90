module ehd
   ! Interface of ehd.h for Fortran 2003. Structures of the bearing are arrays of bytes: allocate them by their sizes,
   !
   !    integer(c_int64_t), allocatable, target :: law(:)
   !    allocate (law(ehd_prepared_size()/8 + 1)); law = 0
   !    status = ehd_prepare(c_loc(law), u, temperature, 0.0d0)
   !
   ! and give their address. Matrices come transposed, (column, row), because C has rows together; both are symmetric.
   use, intrinsic :: iso_c_binding, only: c_double, c_int, c_ptr, c_size_t
   implicit none

   integer(c_int), parameter :: ehd_ok = 0, ehd_above_load = 1, ehd_above_speed = 2, ehd_outside_temperature = 4, &
                                ehd_not_finite = 8, ehd_bad_centrifugal = 16, ehd_too_far = 32, ehd_bad_argument = 64

   ! w [N/m], k [N/m2], c [N s/m2]
   type, bind(c) :: ehd_force
      real(c_double) :: load, stiffness, damping
   end type ehd_force

   ! on the inner ring [N], [N m], and its derivatives
   type, bind(c) :: ehd_bearing_force
      real(c_double) :: force(6), stiffness(6, 6), damping(6, 6)
   end type ehd_bearing_force

   interface
      ! approach [m], rate [m/s], u [m/s], temperature [K], q [N/m]
      integer(c_int) function ehd_law(approach, rate, u, temperature, q, force) bind(c)
         import :: c_int, c_double, ehd_force
         real(c_double), value :: approach, rate, u, temperature, q
         type(ehd_force), intent(out) :: force
      end function ehd_law

      integer(c_int) function ehd_at(point, u, temperature, q) bind(c)
         import :: c_int, c_double, c_ptr
         type(c_ptr), value :: point
         real(c_double), value :: u, temperature, q
      end function ehd_at

      integer(c_int) function ehd_law_at(point, approach, rate, force) bind(c)
         import :: c_int, c_double, c_ptr, ehd_force
         type(c_ptr), value :: point
         real(c_double), value :: approach, rate
         type(ehd_force), intent(out) :: force
      end function ehd_law_at

      integer(c_size_t) function ehd_point_size() bind(c)
         import :: c_size_t
      end function ehd_point_size

      ! clearance [m]; profile: address of the depths of the slices [m], or c_null_ptr
      integer(c_int) function ehd_bearing_make(bearing, clearance, slices, profile) bind(c)
         import :: c_int, c_double, c_ptr
         type(c_ptr), value :: bearing, profile
         real(c_double), value :: clearance
         integer(c_int), value :: slices
      end function ehd_bearing_make

      integer(c_int) function ehd_prepare(law, u, temperature, q) bind(c)
         import :: c_int, c_double, c_ptr
         type(c_ptr), value :: law
         real(c_double), value :: u, temperature, q
      end function ehd_prepare

      ! pose [m], [rad] and velocity [m/s], [rad/s] of the inner ring, cage angle [rad]
      integer(c_int) function ehd_bearing_at(bearing, law, pose, velocity, cage_angle, result) bind(c)
         import :: c_int, c_double, c_ptr, ehd_bearing_force
         type(c_ptr), value :: bearing, law
         real(c_double), intent(in) :: pose(6), velocity(6)
         real(c_double), value :: cage_angle
         type(ehd_bearing_force), intent(out) :: result
      end function ehd_bearing_at

      integer(c_int) function ehd_bearing_call(bearing, law, pose, velocity, cage_angle, u, temperature, q, result) &
         bind(c)
         import :: c_int, c_double, c_ptr, ehd_bearing_force
         type(c_ptr), value :: bearing, law
         real(c_double), intent(in) :: pose(6), velocity(6)
         real(c_double), value :: cage_angle, u, temperature, q
         type(ehd_bearing_force), intent(out) :: result
      end function ehd_bearing_call

      integer(c_size_t) function ehd_bearing_size() bind(c)
         import :: c_size_t
      end function ehd_bearing_size

      integer(c_size_t) function ehd_prepared_size() bind(c)
         import :: c_size_t
      end function ehd_prepared_size
   end interface
end module ehd
