"""The bearing force element: geometry, contact laws, the force with its derivatives, and rollers as bodies."""
