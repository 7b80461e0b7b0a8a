"""Error budget of contacts: by how much they are wrong where a source of error is left out or not known.

============  ==============================================================================
contact_ways  a question at one operating point, and ways of computing its answer
entries       the few that a report looks at
measured      ways asked at random points of a job, each beside the truth of its group; the error budget of a map
============  ==============================================================================
"""
