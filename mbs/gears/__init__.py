"""The mesh of a pair of spur or helical gears."""
