"""Laws that random models must obey."""
