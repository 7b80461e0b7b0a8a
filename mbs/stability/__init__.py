"""Stability at the extremes of the multibody side: what a search over wild input found.

=======  ======================================================================
readers  scenes, bodies of finite elements and measured records, damaged
=======  ======================================================================
"""
