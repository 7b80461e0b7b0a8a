"""From a job to the contacts of single operating points: numbers, films, response over frequency, traction."""
