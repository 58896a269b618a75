"""One ball among fixed surfaces, in floats: length of steps, flight from event to event, plain impacts; interpreted for
one shot, compiled for many."""
