"""Maps in the formats of other programs.

| module | idea |
|---|---|
| `target` | what a target of `ehdmaps export` is, and which ones are registered |
| `header` | what every export says of itself: axes, signs, range, provenance |
"""
