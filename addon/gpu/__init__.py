"""GPUs: ready kernels of Cycles, kernel caches of drivers, and the choice between GPU and processor."""
