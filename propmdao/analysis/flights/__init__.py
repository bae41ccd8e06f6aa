"""Flights over an observer: what is heard, second by second, and what it adds up to."""
