"""Systems as plain files: TOML tables of bodies, laws, contacts and starts."""
