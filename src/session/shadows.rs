//! Cast shadows in drawings: their outlines, and lines that fill them, as strokes on the faces where they fall.

use glam::{DVec2, DVec3, dvec2};

use crate::{
    geom::trig::{cos_deg, sin_deg},
    output::{
        drawing::{Camera, Drawing, Hidden, Kind, Options, Scene, Stroke, visible_lines},
        halftone::{CastShadow, Sun, cast_shadows},
    },
};

/// Direction of the lines in a shadow on paper, degrees.
const ANGLE: f64 = 45.0;

/// Adds to a drawing of a scene what is seen of the shadows in it: their outlines, and lines `pitch` mm apart on paper.
pub fn add(
    drawing: &mut Drawing,
    scene: &Scene,
    camera: &Camera,
    options: &Options,
    (sun, ground, pitch): (&Sun, Option<f64>, f64),
) {
    let shadows = cast_shadows(scene, sun, ground);
    let free = scene.bodies.iter().map(|body| body.id + 1).max().unwrap_or(0);
    let mut strokes = vec![];
    for shadow in &shadows {
        let id = shadow.body.map_or(free, |body| scene.bodies[body].id);
        let mut add = |points| {
            strokes.push(Stroke { points, kind: Kind::Shadow, id, round: None, drawn: vec![] })
        };
        shadow.rim.iter().for_each(|ends| add(ends.to_vec()));
        hatched(shadow, camera, pitch).into_iter().for_each(add);
    }
    let scene = Scene { bodies: scene.bodies.clone(), strokes, ..Scene::default() };
    let options = Options { hidden: Hidden::Off, ..*options };
    let seen = visible_lines(&scene, camera, &options);
    drawing.lines.extend(seen.lines.into_iter().filter(|line| line.kind == Kind::Shadow));
}

/// Straight lines that fill a shadow, parallel on paper; none where it reaches behind the eye.
fn hatched(shadow: &CastShadow, camera: &Camera, pitch: f64) -> Vec<Vec<DVec3>> {
    let along = dvec2(cos_deg(ANGLE), sin_deg(ANGLE));
    let turn = |p: DVec2| dvec2(p.dot(along), p.perp_dot(-along));
    let image = |p: &DVec3| camera.project(*p).map(turn);
    let loops = shadow.outline.iter().map(|points| points.iter().map(image).collect());
    let Some(loops) = loops.collect::<Option<Vec<Vec<DVec2>>>>() else { return vec![] };
    let edges = loops.iter().flat_map(|points| {
        points.iter().zip(points.iter().cycle().skip(1)).map(|(p, q)| (*p / pitch, *q / pitch))
    });
    // Where the outline crosses each line, by the line's number.
    let mut crossings: Vec<(i64, f64)> = vec![];
    for (p, q) in edges {
        let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
        for line in low.y.ceil() as i64..high.y.ceil() as i64 {
            let part = (line as f64 - low.y) / (high.y - low.y);
            crossings.push((line, low.x + (high.x - low.x) * part));
        }
    }
    crossings.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let lifted = |(line, x): (i64, f64)| {
        let at = (along * x + along.perp() * line as f64) * pitch;
        on_plane(camera, at, shadow)
    };
    let ends = crossings.chunks_exact(2).filter(|pair| pair[0].0 == pair[1].0);
    ends.filter_map(|pair| Some(vec![lifted(pair[0])?, lifted(pair[1])?])).collect()
}

/// The point of a shadow's plane that is seen at a place on paper.
fn on_plane(camera: &Camera, at: DVec2, shadow: &CastShadow) -> Option<DVec3> {
    let (from, away) = camera.ray(at);
    let way = shadow.normal.dot(shadow.outline[0][0] - from) / shadow.normal.dot(away);
    way.is_finite().then(|| from + away * way)
}
