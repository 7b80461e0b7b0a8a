"""Scenes: what a scene file says, how it is read (a kind of table a module), and a model made of it."""
