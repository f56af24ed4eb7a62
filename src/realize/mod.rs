//! From the shape graph to solids and plane figures: picks the kernel, keeps results by node, and puts
//! the place in the source on what the kernels report.

mod paint;
mod plane;
mod structure;
