//! Devices of Monado's remote driver: a head and two Index controllers, where a record sent to it says.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::Side;
use wheatstone_core::view::Frustum;

/// Bytes of a record (`struct r_remote_data` of Monado 25).
const RECORD: usize = 376;
const HEAD: usize = 8;
const HEAD_VIEW: usize = 48;
const HEAD_CENTER: usize = HEAD + 2 * HEAD_VIEW;
const HEAD_VIEWS_VALID: usize = HEAD_CENTER + 28;
const CONTROLLERS: [usize; 2] = [136, 256];

/// The connection, and the record that was sent last.
pub(crate) struct Remote {
    stream: TcpStream,
    record: [u8; RECORD],
}

/// A controller.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Controller {
    /// Whether it is switched on.
    pub(crate) active: bool,
    /// Whether a bare hand is seen.
    pub(crate) hand_seen: bool,
    pub(crate) pose: Pose,
    pub(crate) trigger: f32,
    pub(crate) squeeze: f32,
    pub(crate) stick: [f32; 2],
    /// The button that is bound to the menu.
    pub(crate) b: bool,
    /// How far little, ring, middle, index finger and thumb are bent, 0 to 1.
    pub(crate) curl: [f32; 5],
}

impl Controller {
    /// Switched on, with nothing pressed.
    pub(crate) fn at(pose: Pose) -> Self {
        Self {
            active: true,
            hand_seen: false,
            pose,
            trigger: 0.0,
            squeeze: 0.0,
            stick: [0.0; 2],
            b: false,
            curl: [0.0; 5],
        }
    }
}

impl Remote {
    /// Connects; the driver sends its state at the beginning and as it is now.
    pub(crate) fn connect(port: u16) -> Self {
        let connect = |_| {
            std::thread::sleep(Duration::from_millis(10));
            TcpStream::connect(("127.0.0.1", port)).ok()
        };
        let mut stream = (0..1000).find_map(connect).expect("the remote driver does not listen");
        let mut record = [0; RECORD];
        for _ in 0..2 {
            stream.read_exact(&mut record).unwrap();
        }
        record[..HEAD].copy_from_slice(b"mndrmt3\0");
        Self { stream, record }
    }

    /// Moves the head.
    pub(crate) fn head(&mut self, pose: &Pose) -> &mut Self {
        self.pose(HEAD_CENTER, pose)
    }

    /// What the eyes see, and where they are in the head.
    pub(crate) fn eyes(&mut self, eyes: &[(Frustum, Pose); 2]) -> &mut Self {
        for (index, (frustum, pose)) in eyes.iter().enumerate() {
            let tangents = [frustum.left, frustum.right, frustum.up, frustum.down];
            let at = HEAD + index * HEAD_VIEW;
            self.floats(at, &tangents.map(|tangent| tangent.atan() as f32)).pose(at + 16, pose);
        }
        self.record[HEAD_VIEWS_VALID] = 1;
        self
    }

    /// What a hand does.
    pub(crate) fn controller(&mut self, side: Side, controller: &Controller) -> &mut Self {
        let at = CONTROLLERS[side.index()];
        self.pose(at, &controller.pose)
            .floats(at + 52, &controller.curl)
            .floats(at + 72, &[controller.trigger, controller.squeeze])
            .floats(at + 84, &controller.stick);
        self.record[at + 104] = controller.hand_seen.into();
        self.record[at + 105] = controller.active.into();
        self.record[at + 110] = controller.b.into();
        self
    }

    /// Puts what was set in force.
    pub(crate) fn send(&mut self) {
        self.stream.write_all(&self.record).unwrap();
    }

    fn pose(&mut self, at: usize, pose: &Pose) -> &mut Self {
        let position = pose.position_m.as_vec3().to_array();
        self.floats(at, &pose.orientation.as_quat().to_array()).floats(at + 16, &position)
    }

    fn floats(&mut self, at: usize, values: &[f32]) -> &mut Self {
        for (index, value) in values.iter().enumerate() {
            self.record[at + 4 * index..][..4].copy_from_slice(&value.to_le_bytes());
        }
        self
    }
}
