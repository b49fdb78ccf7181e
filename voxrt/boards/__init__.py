"""Scenes for boards: bitstreams, the core's files, what a frame server builds."""
