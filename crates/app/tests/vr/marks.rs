//! Where things are seen.

use crate::monado::Compositor;
use crate::remote::Controller;
use crate::screenshot::Screenshot;
use crate::support::{Place, frustum, pose, stand_of};
use glam::{DVec2, DVec3};
use image::{GrayImage, Luma};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Side, Stand};
use wheatstone_core::view::{AnatomicalDirection, Frustum, world_from_patient};
use wheatstone_core::volume::{Grid, Volume, Voxels};
use wheatstone_io::write_nrrd;

const DIMS: [usize; 3] = [40, 32, 24];
const SPACING_MM: [f64; 3] = [1.0, 1.0, 1.5];

/// Middles of the marks, voxels; no turn or mirror image of them looks like them.
const MARKS: [[f64; 3]; 5] =
    [[5.0, 6.0, 4.0], [35.0, 9.0, 5.0], [20.0, 25.0, 12.0], [8.0, 16.0, 20.0], [33.0, 27.0, 19.0]];
const RADIUS_MM: f64 = 1.5;

/// White marks on black, as bright from wherever they are seen.
const VIEW: &str = r#"{
    "wheatstone_view": 1,
    "file": "marks.nrrd",
    "camera": {"azimuth_deg": 0, "elevation_deg": 0, "distance_m": 1.7, "fov_y_deg": 40, "target_m": [0, 0, 0]},
    "look": {
        "mode": "dvr", "shading": "none", "isovalue": 0.5, "preintegrated": false, "sampling_factor": 1,
        "background": [0, 0, 0], "up": "S"
    },
    "transfer": {
        "color": [[0, 1, 1, 1], [1, 1, 1, 1]], "opacity": [[0, 0], [0.3, 0], [1, 1]], "gradient_opacity": [],
        "window": [0, 255]
    },
    "clip": {"box_lo": [0, 0, 0], "box_hi": [1, 1, 1], "has_handles": false, "plane": null},
    "stereo": {"arrangement": "mono", "eye_distance_m": 0.065, "method": "two_casts"},
    "pace": {"refresh_ms": 40, "warp": "volumetric"}
}"#;

/// Of the refreshes that show the volume, one at which the picture at rest is as fine as it gets; and refreshes in all, of which the first
/// ones show nothing.
const CHECKED: &str = "40";
const REFRESHES: &str = "100";

/// How far a mark may be from where it is to be seen, pixels.
const OFF_PX: f64 = 0.25;

/// The same on the display, which has coarser pixels than the eyes' pictures.
const OFF_ON_DISPLAY_PX: f64 = 1.0;

/// Refreshes after which a picture at rest is as fine as it gets.
const AT_REST: usize = 120;

/// Light that is no mark's, as a part of all of it.
const STRAY: f64 = 0.01;

/// Balls with a soft edge.
fn marks(grid: &Grid) -> Volume {
    let [x, y, z] = DIMS;
    let value = |index: usize| {
        let at = DVec3::from([index % x, index / x % y, index / (x * y)].map(|i| i as f64 + 0.5));
        let distance = |mark: &[f64; 3]| ((at - DVec3::from(*mark)) * DVec3::from(SPACING_MM)).length();
        let nearest = MARKS.iter().map(distance).fold(f64::INFINITY, f64::min);
        (255.0 * (0.5 + 0.5 * (RADIUS_MM - nearest)).clamp(0.0, 1.0)).round() as u8
    };
    Volume::new(grid.clone(), Voxels::U8((0..x * y * z).map(value).collect())).unwrap()
}

/// Where each mark is in the room.
fn places(grid: &Grid, stand: &Stand) -> [DVec3; MARKS.len()] {
    let upright_from_patient = world_from_patient(grid, AnatomicalDirection::Superior);
    let room_from_voxel = stand.world_from_upright() * upright_from_patient * grid.patient_from_voxel();
    MARKS.map(|mark| room_from_voxel.transform_point3(mark.into()))
}

/// The middle of the light about a pixel, and how much there is.
fn light_about(picture: &GrayImage, at: DVec2, radius_px: f64) -> (DVec2, f64) {
    let mut sum = (DVec2::ZERO, 0.0);
    for (x, y, level) in picture.enumerate_pixels() {
        let pixel = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        if pixel.distance(at) < radius_px {
            let light = f64::from(level.0[0]);
            sum = (sum.0 + light * pixel, sum.1 + light);
        }
    }
    (sum.0 / sum.1, sum.1)
}

/// A pair of eyes in a head that looks at the marks.
struct Eyes {
    name: &'static str,
    head: Pose,
    /// Lens and place in the head of the left and the right one.
    pair: [(Frustum, Pose); 2],
}

impl Eyes {
    /// Not alike, and with image planes that are parallel.
    fn different() -> Self {
        let pair = [
            (frustum([-0.9, 0.7, -0.8, 0.6]), pose([-0.031, 0.002, 0.0], [0.0; 3])),
            (frustum([-0.65, 0.95, -0.75, 0.55]), pose([0.034, -0.001, 0.003], [0.0; 3])),
        ];
        Self { name: "different", head: pose([0.2, 1.5, -0.3], [0.4, -0.25, 0.1]), pair }
    }

    /// With image planes that are not parallel.
    fn canted() -> Self {
        let pair = [
            (frustum([-1.0, 0.6, -0.7, 0.7]), pose([-0.032, 0.0, 0.0], [0.1, 0.0, 0.02])),
            (frustum([-0.6, 1.0, -0.7, 0.7]), pose([0.032, 0.0, 0.0], [-0.1, 0.0, -0.01])),
        ];
        Self { name: "canted", pair, ..Self::different() }
    }

    /// Those in the headset from now on, with no hands, of which rays would be seen.
    fn put(&self, place: &Place) {
        let off = Controller { active: false, ..Controller::at(self.head) };
        let mut remote = place.contact().remote();
        let remote = remote.eyes(&self.pair).head(&self.head);
        remote.controller(Side::Left, &off).controller(Side::Right, &off).send();
    }

    fn in_the_room(&self) -> [Eye; 2] {
        self.pair.map(|(frustum, in_head)| {
            let position_m = self.head.position_m + self.head.orientation * in_head.position_m;
            let orientation = self.head.orientation * in_head.orientation;
            Eye { pose: Pose { position_m, orientation }, frustum }
        })
    }
}

/// Compares where marks are in what eyes were shown with where they should be, to within some pixels.
fn check(eyes: &[Eye; 2], grid: &Grid, stand: &Stand, pictures: &[GrayImage; 2], off_px: f64) {
    let [left, right] = eyes;
    let scale_m = stand.longest_side_m / DIMS[0] as f64;
    for (side, picture, eye, other) in
        [("left", &pictures[0], left, right), ("right", &pictures[1], right, left)]
    {
        let view = eye.view([picture.width(), picture.height()]);
        let px_per_tangent = f64::from(picture.width()) / (eye.frustum.right - eye.frustum.left);
        let mut of_marks = 0.0;
        for mark in places(grid, stand) {
            let wanted = view.pixel_position(mark).unwrap();
            let radius_px = 2.0 * RADIUS_MM * scale_m / mark.distance(eye.pose.position_m) * px_per_tangent;
            let (seen, light) = light_about(picture, wanted, radius_px);
            of_marks += light;
            assert!(seen.distance(wanted) < off_px, "{side}: {seen} instead of {wanted}");
            let by_the_other = other.view(view.size).pixel_position(mark).unwrap();
            assert!(by_the_other.distance(wanted) > 10.0, "the eyes see the same");
        }
        let part = of_marks / light_about(picture, DVec2::ZERO, f64::INFINITY).1;
        assert!((1.0 - STRAY..=1.0 + STRAY).contains(&part), "{side}: {part} of the light");
    }
}

/// What is on the display for the left and the right eye.
fn halves(screen: &Screenshot) -> [GrayImage; 2] {
    let [width, height] = screen.size;
    [0, 1].map(|eye| {
        GrayImage::from_fn((width / 2) as u32, height as u32, |x, y| {
            let x = (f64::from(x) + 0.5) / width as f64 + 0.5 * f64::from(eye);
            Luma([screen.at(x, (f64::from(y) + 0.5) / height as f64)[1]])
        })
    })
}

/// A place with the marks in it.
fn place_with_marks(compositor: Compositor, grid: &Grid) -> Option<Place> {
    let place = Place::start(compositor)?;
    write_nrrd(&place.folder().join("marks.nrrd"), &marks(grid)).unwrap();
    std::fs::write(place.folder().join("marks.json"), VIEW).unwrap();
    Some(place)
}

#[test]
fn marks_are_seen_by_each_eye_where_its_lens_and_place_put_them() {
    let grid = Grid::centred(DIMS, SPACING_MM).unwrap();
    let Some(place) = place_with_marks(Compositor::Null, &grid) else { return };
    for eyes in [Eyes::different(), Eyes::canted()] {
        eyes.put(&place);
        let shown = format!("{}-shown", eyes.name);
        let flags = ["marks.json", "--refreshes", REFRESHES];
        let checks = ["--check-every", CHECKED, "--check-pictures", &shown];
        let report = place.begin_vr(eyes.name, &[flags.as_slice(), &checks].concat()).wait().json();
        let pictures = ["left", "right"].map(|side| {
            let file = place.folder().join(&shown).join(format!("refresh_{CHECKED:0>5}_{side}.png"));
            image::open(file).unwrap().into_luma8()
        });
        check(&eyes.in_the_room(), &grid, &stand_of(&report), &pictures, OFF_PX);
    }
}

#[test]
fn marks_come_out_on_the_display_on_the_side_of_each_eye() {
    let grid = Grid::centred(DIMS, SPACING_MM).unwrap();
    let Some(place) = place_with_marks(Compositor::Screen, &grid) else { return };
    // The display keeps the lenses that it begins with, and so do the eyes. Nothing but the marks is to be seen.
    let head = Eyes::different().head;
    let off = Controller { active: false, ..Controller::at(head) };
    let mut remote = place.contact().remote();
    remote.head(&head).controller(Side::Left, &off).controller(Side::Right, &off).send();
    let mut vr = place.begin_vr("display", &["marks.json"]);
    vr.pass(AT_REST);
    let eyes = vr.ticks().last().and_then(|tick| tick.eyes).unwrap();
    let screen = place.contact().screen();
    let report = vr.interrupt().json();
    check(&eyes, &grid, &stand_of(&report), &halves(&screen), OFF_ON_DISPLAY_PX);
}
