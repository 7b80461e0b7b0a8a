"""A report as one file of HTML: pages, tables and charts that need no network and no program but a browser.

The modules in the order in which data pass through them:

=============  ====================================================================================
axis           axes of charts: ends, places of values, ticks
chart          curves over a common axis as inline SVG, with ticks and the numbers that a cursor reads off
page           the whole document: escaped markup, tables, style, script, and the rule that nothing is loaded
document.css   how it looks on a screen and on paper
document.js    reads values off the charts; all else works without it
=============  ====================================================================================

What is said of a map is in `ehdmaps.jobs.show.map_report`, and of a scene in `mbs.report`. Nothing is imported here:
take the names from their modules.
"""
