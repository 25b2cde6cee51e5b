"""The modules of scripts/make-assets: geometry, painting, and writers for PNG and GLB."""
