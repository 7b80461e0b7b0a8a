"""The result of an identification for people: text and figure."""
