"""Programs of libethd that are written in Python, and what they share. Needs no compiled part: ethd builds on it."""
