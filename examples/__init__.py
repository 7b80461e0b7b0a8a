"""Scripts that show how the library is used, and the package `housings`, which makes the shipped housings anew."""
