"""Faults planted in the code that guards: does a test notice?"""
