"""Error budget of contacts: by how much they are wrong where a source of error is left out or not known.

============  ==============================================================================
answers       a question at one operating point, and the answer to it
contact_ways  ways of computing a contact
entries       the few that a report looks at
measured      ways asked at random points of a job, each beside the truth of its group
map_budget    the error budget of a map
============  ==============================================================================
"""
