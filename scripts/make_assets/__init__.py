"""What scripts/make-assets is made of: geometry, painting, and a writer for PNG and GLB."""
