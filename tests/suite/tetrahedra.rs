//! Tetrahedra of solids: volumes, neighbours, point location, files.

use std::{collections::BTreeMap, path::Path};

use glam::{DVec3, dvec3};
use katachi::{
    base::Shelf,
    geom::spherical_projection::Projection,
    kernel::{
        brep::{Polyhedron, boolean::evaluate, measure},
        tet::{
            complex::Complex,
            constrained::{NoTetrahedra, tetrahedralize},
            walk::Walk,
        },
    },
    output::elements::ElementFormat,
    session::Format,
};

use crate::{
    laws::{Random, style, tree},
    made::Made,
};

/// The solid of a random construction tree, if there is any.
fn random_solid(seed: u64) -> Option<Polyhedron> {
    let tree = tree(&mut Random(seed), &style(seed), 3);
    evaluate(&tree).ok().map(|evaluated| evaluated.solid).filter(|solid| !solid.is_empty())
}

/// A complex that is sound and as large as its solid.
fn filled(solid: &Polyhedron) -> Result<Complex, NoTetrahedra> {
    let complex = tetrahedralize(solid.mesh())?;
    assert_eq!(complex.check(), Ok(()));
    let volume = measure::volume(solid);
    assert!((complex.volume() / volume - 1.0).abs() < 1e-6, "{} of {volume}", complex.volume());
    Ok(complex)
}

#[test]
fn random_solids_are_filled() {
    let (mut whole, mut refused) = (0, vec![]);
    for seed in 0..1000 {
        let Some(solid) = random_solid(seed) else { continue };
        match filled(&solid) {
            Ok(_) => whole += 1,
            Err(why) => refused.push((seed, why)),
        }
    }
    // What is refused has edges that nearly touch: some in a thousand trees of leaves turned by odd angles.
    assert!(whole > 800 && refused.len() <= 13, "{whole} filled, refused {refused:?}");
    assert!(refused.iter().all(|(_, why)| {
        matches!(why, NoTetrahedra::TooMany { .. } | NoTetrahedra::Crossing { .. })
    }));
}

#[test]
fn walking_and_the_spherical_test_agree() {
    let mut asked = 0;
    for seed in 0..200 {
        let Some(Ok(complex)) = random_solid(seed).map(|solid| filled(&solid)) else { continue };
        let boundary = random_solid(seed).expect("again");
        let sphere = Projection::new(boundary.mesh());
        let (mut walk, mut random) = (Walk::new(&complex), Random(seed));
        for _ in 0..600 {
            let point = DVec3::from_array([(); 3].map(|()| random.unit() * 9.0 - 1.0));
            assert_eq!(
                walk.locate(point).is_some(),
                sphere.inside(point),
                "seed {seed} at {point}"
            );
            asked += 1;
        }
    }
    assert!(asked > 90_000, "{asked}");
}

#[test]
fn walking_finds_the_tetrahedron_that_holds_a_point() {
    let complex = filled(&(0..).find_map(random_solid).expect("a solid")).expect("sound");
    let mesh = complex.mesh();
    let mut walk = Walk::new(&complex);
    for t in 0..mesh.tetrahedra.len() {
        let middle = mesh.corners(t).iter().sum::<DVec3>() / 4.0;
        let found = walk.locate(middle).expect("inside") as usize;
        // In a sliver the middle is no more inside than rounding allows.
        assert!(found == t || mesh.volume_of(t) < 1e-9, "{found} for {t}");
    }
    assert_eq!(walk.locate(dvec3(1e9, 0.0, 0.0)), None);
    assert_eq!(walk.locate(DVec3::NAN), None);
}

/// A model and what its files hold.
fn written(model: &str, format: ElementFormat) -> String {
    let shelf = [("m.kata", model)];
    let made = Made::of(&Shelf(&shelf), "m.kata", &[Format::Elements(format)]).expect("sound");
    assert_eq!(made.files.len(), 1);
    String::from_utf8(made.files[0].1.clone()).expect("text")
}

#[test]
fn a_gmsh_file_has_the_volume_of_the_model() {
    let text = written(
        "part plate = (box(40, 30, 5) - cylinder(d = 12, h = 20)).tag(\"plate\")",
        ElementFormat::Msh,
    );
    let section = |name: &str| {
        let (_, rest) = text.split_once(&format!("${name}\n")).expect("begins");
        rest.split_once(&format!("$End{name}")).expect("ends").0.lines().collect::<Vec<_>>()
    };
    let nodes = section("Nodes");
    let count: usize = nodes[0].split(' ').nth(1).expect("count").parse().expect("a number");
    let points: Vec<DVec3> = nodes[2 + count..]
        .iter()
        .map(|line| {
            let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().expect("a number")).collect();
            dvec3(numbers[0], numbers[1], numbers[2])
        })
        .collect();
    assert_eq!(points.len(), count);
    let mut volume = 0.0;
    let mut kinds: BTreeMap<usize, usize> = BTreeMap::new();
    for line in &section("Elements")[1..] {
        let numbers: Vec<usize> = line.split(' ').map(|x| x.parse().expect("a number")).collect();
        if numbers.len() == 5 {
            let [a, b, c, d] = [1, 2, 3, 4].map(|i| points[numbers[i] - 1]);
            let part = (b - a).cross(c - a).dot(d - a) / 6.0;
            assert!(part > 0.0, "an element is turned inside out");
            volume += part;
        }
        *kinds.entry(numbers.len()).or_default() += 1;
    }
    let made = Made::of(
        &Shelf(&[("m.kata", "part plate = box(40, 30, 5) - cylinder(d = 12, h = 20)")]),
        "m.kata",
        &[],
    );
    let expected = made.expect("sound").parts[0].1.volume;
    assert!((volume / expected - 1.0).abs() < 1e-6, "{volume} of {expected}");
    assert!(text.contains("\"plate.plate\"") && text.contains("3 1 \"plate\""), "groups by tag");
}

#[test]
fn examples_are_filled() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    for name in ["bracket", "pipe_flange", "gear", "torus", "menger_sponge", "enclosure"] {
        let file = folder.join(format!("{name}.kata"));
        let made = Made::of_file(&file, &[Format::Elements(ElementFormat::Vtu)]);
        assert!(!made.expect(name).files.is_empty(), "{name}");
    }
}
