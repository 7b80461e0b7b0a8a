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

   ! of a film with memory: xi [m], change of G [N s/m2], load [N/m]
   type, bind(c) :: ehd_film_state
      real(c_double) :: approach, change, load
   end type ehd_film_state

   ! load [N/m] and rate [m/s], each with its derivatives by approach and state
   type, bind(c) :: ehd_film_rates
      real(c_double) :: load, stiffness, by_state, rate, rate_by_approach, rate_by_state
   end type ehd_film_rates

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

      ! films with memory; film: address of ehd_film_size() bytes, all zero before the first call
      integer(c_int) function ehd_film_at(film, u, temperature) bind(c)
         import :: c_int, c_double, c_ptr
         type(c_ptr), value :: film
         real(c_double), value :: u, temperature
      end function ehd_film_at

      integer(c_int) function ehd_film_settled(film, approach, state) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_state
         type(c_ptr), value :: film
         real(c_double), value :: approach
         type(ehd_film_state), intent(out) :: state
      end function ehd_film_settled

      integer(c_int) function ehd_film_advance(film, step, last_step, approach, before, after, force) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_state, ehd_force
         type(c_ptr), value :: film
         real(c_double), value :: step, last_step, approach
         type(ehd_film_state), intent(in) :: before
         type(ehd_film_state), intent(out) :: after
         type(ehd_force), intent(out) :: force
      end function ehd_film_advance

      integer(c_int) function ehd_film_rate(film, approach, state, rates) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_rates
         type(c_ptr), value :: film
         real(c_double), value :: approach, state
         type(ehd_film_rates), intent(out) :: rates
      end function ehd_film_rate

      integer(c_size_t) function ehd_film_size() bind(c)
         import :: c_size_t
      end function ehd_film_size

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

      ! states: one for each slice of each roller, roller by roller
      integer(c_int) function ehd_bearing_settled(bearing, film, pose, cage_angle, states) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_state
         type(c_ptr), value :: bearing, film
         real(c_double), intent(in) :: pose(6)
         real(c_double), value :: cage_angle
         type(ehd_film_state), intent(out) :: states(*)
      end function ehd_bearing_settled

      integer(c_int) function ehd_bearing_advance(bearing, film, step, last_step, pose, cage_angle, before, after, &
                                                  result) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_state, ehd_bearing_force
         type(c_ptr), value :: bearing, film
         real(c_double), value :: step, last_step, cage_angle
         real(c_double), intent(in) :: pose(6)
         type(ehd_film_state), intent(in) :: before(*)
         type(ehd_film_state), intent(out) :: after(*)
         type(ehd_bearing_force), intent(out) :: result
      end function ehd_bearing_advance

      integer(c_int) function ehd_bearing_rates(bearing, film, pose, cage_angle, states, rates, result) bind(c)
         import :: c_int, c_double, c_ptr, ehd_film_rates, ehd_bearing_force
         type(c_ptr), value :: bearing, film
         real(c_double), intent(in) :: pose(6), states(*)
         real(c_double), value :: cage_angle
         type(ehd_film_rates), intent(out) :: rates(*)
         type(ehd_bearing_force), intent(out) :: result
      end function ehd_bearing_rates

      integer(c_size_t) function ehd_bearing_size() bind(c)
         import :: c_size_t
      end function ehd_bearing_size

      integer(c_size_t) function ehd_prepared_size() bind(c)
         import :: c_size_t
      end function ehd_prepared_size
   end interface
end module ehd
