"""Contacts: when things touch and where, and how a surface responds."""
