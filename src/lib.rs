//! Katachi (形, *shape*): a small declarative language for solid modelling.
//!
//! A `.kata` file is lexed, parsed and evaluated into a graph of shapes, the graph is realised as exact
//! polyhedra, and these are written as meshes or drawn as lines on paper. This page is the floor plan and a tour; the language
//! itself is described in the README, `grammar/katachi.ebnf` and the library in `stdlib/`.
//!
//! # A tour
//!
//! A file of one shape is a model. [`session`] is the one road through it all:
//!
//! ```
//! use katachi::{base::{Shelf, watch::Unwatched}, session::Session};
//! let shelf = Shelf(&[("die.kata", "box(20, 20, 20) - sphere(d = 26, sides = 64).move(z = 10)")]);
//! let session = Session::new(&shelf, &Unwatched, None);
//! let (mut model, diagnostics) = session.compile("die.kata", &[]);
//! assert!(diagnostics.is_empty());
//! let die = &model.measure(&[]).found[0].1;
//! assert!(die.closed && die.volume < 8000.0);
//! ```
//!
//! Text becomes a tree ([`syntax`]); what cannot be read is told with its place:
//!
//! ```
//! use katachi::{base::SourceId, syntax::parse};
//! let (_, diagnostics) = parse(SourceId(0), "w = 40mm +\n");
//! assert_eq!(diagnostics[0].span().unwrap().start, 9);
//! ```
//!
//! Solids can be had without the language ([`kernel::brep`]); set operations are exact, so that a flush
//! cut leaves no film:
//!
//! ```
//! use glam::dvec3;
//! use katachi::kernel::brep::{boolean::{Tree, evaluate}, measure, primitive::cuboid};
//! let block = cuboid(dvec3(0., 0., 0.), dvec3(3., 3., 1.));
//! let slot = cuboid(dvec3(1., 0., 0.), dvec3(2., 3., 1.));
//! let leaf = |solid| Tree::Leaf(std::sync::Arc::new(solid));
//! let cut = evaluate(&Tree::Difference(vec![leaf(block), leaf(slot)])).unwrap();
//! assert_eq!(measure::volume(&cut.solid), 6.0);
//! assert_eq!(measure::shells(&cut.solid), 2);
//! ```
//!
//! Whether a point is inside is a question of solid angles ([`geom::spherical_projection`]):
//!
//! ```
//! use glam::dvec3;
//! use katachi::{geom::spherical_projection::solid_angle, kernel::brep::primitive::cuboid};
//! let cube = cuboid(dvec3(0., 0., 0.), dvec3(1., 1., 1.));
//! let corner = solid_angle(cube.mesh(), dvec3(0., 0., 0.));
//! assert!((corner - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
//! ```
//!
//! # Floor plan
//!
//! A room may import those before it, and only where the table of `tests/suite/floors.rs` says so.
//!
//! | room | what it does |
//! |---|---|
//! | [`base`] | places in source text, diagnostics as data, the one door to files |
//! | [`geom`] | what all kernels share: exact predicates, placements, curves, surfaces, meshes |
//! | [`syntax`] | text to tree |
//! | [`shape`] | the graph of construction steps |
//! | [`eval`] | names, values, dimensions, calls; binds `stdlib/` to the graph |
//! | [`input`] | readers of meshes, drawings and values |
//! | [`kernel`] | exact polyhedra ([`kernel::brep`]), plane figures ([`kernel::profile`]), distance fields ([`kernel::field`]) and tetrahedra ([`kernel::tet`]) |
//! | [`convert`] | offsets and fillets of polyhedra, held against their distance fields; solids of level sets |
//! | [`realize`] | graph to solids |
//! | [`output`] | writers of mesh files and OpenSCAD source, drawings ([`output::drawing`]), the sheets they stand on ([`output::sheet`]), half-tones ([`output::halftone`]) |
//! | [`session`] | the one road through it all |
//! | [`app`] | the command line, the only room that touches files, clock and terminal |
//!
//! # Papers
//!
//! | paper | where |
//! |---|---|
//! | S. Nagashima, *A spatial inclusion test for polyhedra using a spherical projection*, 1986 | [`geom::spherical_projection`], and the seeds of [`kernel::brep::boolean`] |
//! | S. Tatehara, N. Tanaka, S. Tatsumi, K. Tokumasu, *Object-oriented expression for complex 3-D shapes* | [`kernel::field`], [`convert::offset`] |
//! | Y. Arakawa, solids of tetrahedra with closed adjacency; H. Si, K. Gärtner, *3D boundary recovery by constrained Delaunay tetrahedralization*, 2011; L. Diazzi, D. Panozzo, A. Vaxman, M. Attene, *Constrained Delaunay Tetrahedrization*, 2023 | [`kernel::tet`] |
//! | S. Nakajima, isometric input and surfaces from two rails (METHODS, section 4) | [`geom::curve`], [`kernel::brep::sweep`] |
//! | W. Wang, B. Jüttler, D. Zheng, Y. Liu, *Computation of rotation minimizing frames*; S. A. Coons, *Surfaces for computer-aided design of space forms* | [`kernel::brep::sweep`] |
//! | T. Ju, F. Losasso, S. Schaefer, J. Warren, *Dual contouring of hermite data*; S. Schaefer, T. Ju, J. Warren, *Manifold dual contouring*; T. Ju, T. Udeshi, *Intersection-free contouring on an octree grid* | [`kernel::field::contour`] |
//! | G. Wyvill, C. McPheeters, B. Wyvill, *Data structure for soft objects*; J. F. Blinn, *A generalization of algebraic surface drawing* | [`geom::charge`] |
//! | R. E. Moore, *Interval analysis* | [`geom::formula`] |
//! | T. Nishita, hidden lines and half-tones of three-dimensional scenes, 1972 (METHODS, section 3) | [`output::drawing`], [`output::halftone`] |

pub mod app;
pub mod base;
pub mod convert;
pub mod eval;
pub mod geom;
pub mod input;
pub mod kernel;
pub mod output;
pub mod realize;
pub mod session;
pub mod shape;
pub mod syntax;
