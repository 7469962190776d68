"""Systems as plain files: TOML or YAML tables of bodies, laws, contacts and starts."""
