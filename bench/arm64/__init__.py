"""The same log on another processor: is every number of the loop the same?"""
