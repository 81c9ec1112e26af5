"""The workbench in a browser: a folder of plain files, its data checked, its models compared and mended.

The server reads and writes the files that the command line reads and writes, and does all work by
`import twin` in processes of their own. docs/studio.md.
"""
