"""Commands on one bearing without a scene: its values read, and ball bearings."""
