//! Where the eye is and what the picture plane is.

use glam::{DMat3, DVec2, DVec3, dvec2};
use thiserror::Error;

use crate::geom::{View, trig::tan_deg};

/// The part of the eye's distance from the target within which nothing is drawn: a picture has to end
/// before the eye, where points have no image.
const NEAREST: f64 = 1e-2;

/// Directions are parallel to the z axis when the part of them across it is this small: below that the
/// picture's x axis would be rounding noise.
const UPRIGHT: f64 = 1e-12;

/// A rectangle of the picture plane, millimetres.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Window {
    /// Left and lower border.
    pub min: DVec2,
    /// Right and upper border.
    pub max: DVec2,
}

/// A parallel or a perspective projection onto a plane through the target, so that lengths in that plane
/// are true.
///
/// The picture has x to the right and y up, its origin at the image of the target, in millimetres.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Camera {
    right: DVec3,
    up: DVec3,
    /// Unit vector from the target towards the eye.
    toward: DVec3,
    target: DVec3,
    /// Distance of the eye from the target; `None` is a parallel projection.
    distance: Option<f64>,
    window: Option<Window>,
}

/// Why there is no such camera.
#[derive(Clone, Copy, PartialEq, Debug, Error)]
pub enum CameraError {
    /// A direction without a length.
    #[error("the direction of view is {0}; it needs a finite length above 0")]
    NoDirection(DVec3),
    /// Eye and target in one place.
    #[error("the eye is at the target, ({}, {}, {}); they need to be apart", .0.x, .0.y, .0.z)]
    EyeAtTarget(DVec3),
    /// An angle that opens no window.
    #[error("the field of view is {0} degrees; it must be above 0 and below 180")]
    FieldOfView(f64),
    /// A field of view without an eye.
    #[error("a parallel projection has no field of view; give a window or an eye")]
    NoEye,
    /// A rectangle without area.
    #[error("the window is {} x {} mm; both need to be above 0", .0.x, .0.y)]
    EmptyWindow(DVec2),
}

impl Camera {
    /// A parallel projection from a direction towards the eye, z up; along the z axis, y is up. The target
    /// is the origin.
    ///
    /// ```
    /// use glam::{DVec3, dvec2};
    /// use katachi::output::drawing::Camera;
    /// let front = Camera::parallel(DVec3::NEG_Y).unwrap();
    /// assert_eq!(front.project(DVec3::new(2.0, 9.0, 3.0)), Some(dvec2(2.0, 3.0)));
    /// ```
    pub fn parallel(direction: DVec3) -> Result<Camera, CameraError> {
        let toward = direction.try_normalize().ok_or(CameraError::NoDirection(direction))?;
        let across = dvec2(toward.x, toward.y).length();
        let right = if across < UPRIGHT { DVec3::Y } else { DVec3::Z }.cross(toward).normalize();
        let up = toward.cross(right);
        Ok(Camera { right, up, toward, target: DVec3::ZERO, distance: None, window: None })
    }

    /// One of the usual views; unlike the direction -z, `Bottom` has +y down, as a sheet unfolds it.
    pub fn view(view: View) -> Camera {
        let camera = Camera::parallel(view.direction()).expect("a view has a direction");
        match view {
            View::Bottom => Camera { right: DVec3::X, up: DVec3::NEG_Y, ..camera },
            _ => camera,
        }
    }

    /// A perspective from an eye, with the picture plane through the target, z up.
    ///
    /// ```
    /// use glam::{DVec3, dvec2, dvec3};
    /// use katachi::output::drawing::Camera;
    /// let camera = Camera::perspective(dvec3(0.0, -50.0, 0.0), DVec3::ZERO).unwrap();
    /// assert_eq!(camera.project(dvec3(3.0, 0.0, 4.0)), Some(dvec2(3.0, 4.0)));
    /// assert_eq!(camera.project(dvec3(3.0, 50.0, 4.0)), Some(dvec2(1.5, 2.0)));
    /// ```
    pub fn perspective(eye: DVec3, target: DVec3) -> Result<Camera, CameraError> {
        let away = eye - target;
        let camera = Camera::parallel(away).map_err(|_| CameraError::EyeAtTarget(eye))?;
        Ok(Camera { target, distance: Some(away.length()), ..camera })
    }

    /// The same projection with its picture origin at the image of `target`; a parallel one only moves, a
    /// perspective keeps its direction and distance.
    pub fn at(self, target: DVec3) -> Camera {
        Camera { target, ..self }
    }

    /// Draws only what falls into a rectangle of the picture. Fails for one without area.
    pub fn with_window(self, window: Window) -> Result<Camera, CameraError> {
        let size = window.max - window.min;
        let real = size.is_finite() && size.cmpgt(DVec2::ZERO).all();
        if real {
            Ok(Camera { window: Some(window), ..self })
        } else {
            Err(CameraError::EmptyWindow(size))
        }
    }

    /// Draws only what the eye sees within a full vertical angle in degrees; `aspect` is the window's width
    /// over its height. Fails for a parallel projection and for an angle outside (0, 180).
    pub fn with_field_of_view(self, degrees: f64, aspect: f64) -> Result<Camera, CameraError> {
        let distance = self.distance.ok_or(CameraError::NoEye)?;
        if !(degrees > 0.0 && degrees < 180.0) {
            return Err(CameraError::FieldOfView(degrees));
        }
        let half = distance * tan_deg(degrees / 2.0);
        let corner = dvec2(half * aspect, half);
        self.with_window(Window { min: -corner, max: corner })
    }

    /// The eye; `None` for a parallel projection.
    pub fn eye(&self) -> Option<DVec3> {
        self.distance.map(|d| self.target + self.toward * d)
    }

    /// Unit vector towards the eye: everywhere in a parallel projection, at the target in a perspective.
    pub fn toward(&self) -> DVec3 {
        self.toward
    }

    /// The camera turned level, so that z is upright in its picture; `None` when it looks along z.
    pub(super) fn level(&self) -> Option<Camera> {
        let Some(distance) = self.distance else {
            return (self.toward.with_z(0.0).length() > UPRIGHT).then_some(*self);
        };
        let eye = self.target + self.toward * distance;
        let flat = self.toward.with_z(0.0) * distance;
        let camera = Camera::perspective(eye, eye - flat).ok()?;
        (flat.length() > UPRIGHT * distance).then_some(camera)
    }

    /// The point whose image is the picture's origin.
    pub fn target(&self) -> DVec3 {
        self.target
    }

    /// The vector from a point towards the eye, not a unit vector in a perspective.
    pub fn sight(&self, p: DVec3) -> DVec3 {
        self.eye().map_or(self.toward, |eye| eye - p)
    }

    /// The rectangle drawn, if there is one.
    pub fn window(&self) -> Option<Window> {
        self.window
    }

    /// The frame of the picture in space: right, up and towards the eye.
    pub fn frame(&self) -> DMat3 {
        DMat3::from_cols(self.right, self.up, self.toward)
    }

    /// Whether points can lie behind the eye.
    pub fn is_perspective(&self) -> bool {
        self.distance.is_some()
    }

    /// How much larger the image of a length across the sight line at `p` is than the length: 1 in a parallel
    /// projection and in the picture plane. Not positive behind the eye.
    pub fn magnification(&self, p: DVec3) -> f64 {
        self.distance.map_or(1.0, |d| d / (d - (p - self.target).dot(self.toward)))
    }

    /// Distance in front of the plane before the eye in which the picture ends; negative beyond it. Infinite for a
    /// parallel projection.
    pub fn ahead(&self, p: DVec3) -> f64 {
        self.distance
            .map_or(f64::INFINITY, |d| d * (1.0 - NEAREST) - (p - self.target).dot(self.toward))
    }

    /// The image of a point, and its magnification. Meaningless where [`Camera::ahead`] is negative.
    pub(super) fn image(&self, p: DVec3) -> (DVec2, f64) {
        let v = p - self.target;
        let k = self.distance.map_or(1.0, |d| d / (d - v.dot(self.toward)));
        (dvec2(v.dot(self.right), v.dot(self.up)) * k, k)
    }

    /// How fast the image of a point moves when the point moves with a velocity.
    pub(super) fn image_velocity(&self, p: DVec3, velocity: DVec3) -> DVec2 {
        let (at, k) = self.image(p);
        let straight = dvec2(velocity.dot(self.right), velocity.dot(self.up)) * k;
        self.distance.map_or(straight, |d| straight + at * (velocity.dot(self.toward) * k / d))
    }

    /// The image of a point; `None` when it is not in front of the eye.
    pub fn project(&self, p: DVec3) -> Option<DVec2> {
        (self.ahead(p) >= 0.0).then(|| self.image(p).0)
    }

    /// The sight line of a point of the picture: a point in the picture plane and the direction away from
    /// the eye, not a unit vector.
    pub fn ray(&self, at: DVec2) -> (DVec3, DVec3) {
        let p = self.target + self.right * at.x + self.up * at.y;
        (p, -self.sight(p))
    }
}

#[cfg(test)]
mod tests {
    use glam::dvec3;

    use super::*;

    fn image(view: View, p: DVec3) -> [f64; 2] {
        Camera::view(view).project(p).expect("parallel").to_array()
    }

    #[test]
    fn views_unfold_as_on_a_sheet() {
        let p = dvec3(1.0, 2.0, 3.0);
        assert_eq!(image(View::Front, p), [1.0, 3.0]);
        assert_eq!(image(View::Back, p), [-1.0, 3.0]);
        assert_eq!(image(View::Left, p), [-2.0, 3.0]);
        assert_eq!(image(View::Right, p), [2.0, 3.0]);
        assert_eq!(image(View::Top, p), [1.0, 2.0]);
        assert_eq!(image(View::Bottom, p), [1.0, -2.0]);
    }

    #[test]
    fn axes_shrink_as_named() {
        let shrink = |view, axis| Camera::view(view).project(axis).expect("parallel").length();
        for axis in DVec3::AXES {
            assert!((shrink(View::Iso, axis) - (2.0f64 / 3.0).sqrt()).abs() < 1e-15);
        }
        let [x, y, z] = DVec3::AXES.map(|axis| shrink(View::Dimetric, axis));
        assert!((x - z).abs() < 1e-15 && (x - 2.0 * y).abs() < 1e-15);
    }

    #[test]
    fn what_opens_no_picture_is_refused() {
        let at = |eye| Camera::perspective(eye, DVec3::X);
        assert_eq!(at(DVec3::X), Err(CameraError::EyeAtTarget(DVec3::X)));
        let camera = at(DVec3::ZERO).expect("apart");
        assert_eq!(camera.with_field_of_view(180.0, 1.0), Err(CameraError::FieldOfView(180.0)));
        let top = Camera::view(View::Top);
        assert_eq!(top.with_field_of_view(40.0, 1.0), Err(CameraError::NoEye));
        let window = Window { min: DVec2::ZERO, max: DVec2::X };
        assert!(top.with_window(window).is_err());
        assert!(Camera::parallel(DVec3::NAN).is_err());
    }

    #[test]
    fn rays_come_back() {
        let camera = Camera::perspective(dvec3(30.0, -40.0, 20.0), dvec3(1.0, 2.0, 3.0)).unwrap();
        let at = dvec2(5.0, -7.0);
        let (p, away) = camera.ray(at);
        for t in [0.0, 0.5, 3.0] {
            assert!(camera.project(p + away * t).unwrap().distance(at) < 1e-12);
        }
        assert_eq!(camera.project(dvec3(60.0, -80.0, 40.0)), None);
    }
}
