"""The mesh of a pair of spur gears."""
