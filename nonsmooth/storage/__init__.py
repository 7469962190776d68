"""Files of results and studies: chunks of arrays with checksums, commits that survive a power cut, locks."""
