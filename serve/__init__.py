"""The frame server: session, uploads, browser page, client library, legacy protocol."""
