//! Runs `wheatstone vr` in Monado and watches what it is told.

use crate::monado::{Compositor, Contact, Monado};
use glam::{DQuat, DVec3, EulerRot};
use serde_json::Value;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Recording, Stand, Tick};
use wheatstone_core::view::Frustum;

/// Refreshes after which what a test waits for counts as not coming.
const PATIENCE: usize = 600;

/// The binary under test.
pub(crate) const WHEATSTONE: &str = env!("CARGO_BIN_EXE_wheatstone");

/// Monado, and a folder with `sphere.nrrd` of 24³ voxels.
pub(crate) struct Place {
    /// Ends before the folder is removed.
    monado: Monado,
    folder: TempDir,
}

/// What a run left: exit code and both streams.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// The one JSON object on standard output of a run that went well.
    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.code, 0, "{}", self.stderr);
        assert_eq!(self.stdout.lines().count(), 1, "{}", self.stdout);
        serde_json::from_str(&self.stdout).unwrap()
    }

    /// The one error of a run that failed, without a panic.
    pub(crate) fn error(&self) -> &str {
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        let own = |line: &&str| line.starts_with("error: ") && !line.contains("XDG_RUNTIME_DIR");
        let errors: Vec<_> = self.stderr.lines().filter(own).collect();
        assert!(errors.len() == 1 && self.stdout.is_empty(), "{self:?}");
        errors[0]
    }
}

/// Runs the binary in a folder, without a headset.
pub(crate) fn wheatstone(folder: &Path, args: &[&str]) -> Run {
    let output = Command::new(WHEATSTONE).args(args).current_dir(folder).output().unwrap();
    Run {
        code: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A folder with `sphere.nrrd` of 24³ voxels.
pub(crate) fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let run = wheatstone(folder.path(), &["phantom", "sphere", "--size", "24", "-o", "sphere.nrrd"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    folder
}

impl Place {
    /// Nothing, with the reason told, where there is no Monado and that is all right.
    pub(crate) fn start(compositor: Compositor) -> Option<Self> {
        Some(Self { monado: Monado::start(compositor)?, folder: folder() })
    }

    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// The service, to talk to.
    pub(crate) fn contact(&self) -> Contact {
        self.monado.contact()
    }

    /// Begins `wheatstone vr` with a recording of what it is told, and some more flags.
    pub(crate) fn begin_vr(&self, name: &str, flags: &[&str]) -> Started {
        let records = self.folder().join(name);
        std::fs::create_dir(&records).unwrap();
        let record = records.join("session.jsonl");
        let vr = ["vr", "--no-mirror", "--json", "--record", record.to_str().unwrap()];
        let mut started = self.begin(name, &[&vr, flags].concat(), &[]);
        started.records = Some(records);
        started
    }

    /// Begins the binary with some environment variables.
    pub(crate) fn begin(&self, name: &str, args: &[&str], environment: &[(&str, &str)]) -> Started {
        let streams = ["out", "err"].map(|stream| self.folder().join(format!("{name}.{stream}")));
        let [out, err] = streams.each_ref().map(|stream| File::create(stream).unwrap());
        let mut command = self.monado.command(Path::new(WHEATSTONE));
        command.args(args).current_dir(self.folder()).envs(environment.iter().copied());
        let child = command.stdin(Stdio::null()).stdout(out).stderr(err).spawn().unwrap();
        Started { child, streams, records: None }
    }

    /// Runs the binary.
    pub(crate) fn run(&self, args: &[&str]) -> Run {
        self.begin("run", args, &[]).wait()
    }
}

/// A run that has begun; it ends with this.
pub(crate) struct Started {
    child: Child,
    /// Files that the streams go to.
    streams: [PathBuf; 2],
    /// The folder of its recording, in which a file grows until it is whole.
    records: Option<PathBuf>,
}

impl Started {
    /// The recording as far as it is written.
    fn record(&self) -> Vec<u8> {
        let mut files = std::fs::read_dir(self.records.as_ref().unwrap()).unwrap();
        files.next().map_or_else(Vec::new, |file| std::fs::read(file.unwrap().path()).unwrap_or_default())
    }

    /// How many refreshes it has been told of so far, but for what it has not written yet.
    pub(crate) fn told(&self) -> usize {
        self.record().iter().filter(|byte| **byte == b'\n').count().saturating_sub(1)
    }

    /// What it has been told so far, but for what it has not written yet.
    pub(crate) fn ticks(&self) -> Vec<Tick> {
        let text = self.record();
        let whole = text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        Recording::read(&text[..whole]).map_or_else(|_| Vec::new(), |recording| recording.ticks().to_vec())
    }

    /// Waits until it has been told something.
    pub(crate) fn until(&mut self, what: &str, wanted: impl Fn(&Tick) -> bool) {
        let begin = self.ticks().len();
        loop {
            let ticks = self.ticks();
            if ticks.iter().skip(begin).any(&wanted) {
                return;
            }
            let since = ticks.len() - begin.min(ticks.len());
            assert!(since < PATIENCE, "{what} does not come; last: {:#?}", ticks.last());
            self.assert_runs(what);
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Waits until it has been told so many more refreshes.
    pub(crate) fn pass(&mut self, refreshes: usize) {
        let end = self.ticks().len() + refreshes;
        while self.ticks().len() < end {
            self.assert_runs("the next refresh");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    fn assert_runs(&mut self, what: &str) {
        let ended = self.child.try_wait().unwrap();
        assert!(
            ended.is_none(),
            "ended before {what}: {}",
            std::fs::read_to_string(&self.streams[1]).unwrap()
        );
    }

    /// Whether it has not ended yet.
    pub(crate) fn runs(&mut self) -> bool {
        self.child.try_wait().unwrap().is_none()
    }

    /// Ends it by Ctrl-C.
    pub(crate) fn interrupt(self) -> Run {
        let process = self.child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &process]).status().unwrap().success());
        self.wait()
    }

    /// Waits until it ends.
    pub(crate) fn wait(mut self) -> Run {
        let status = self.child.wait().unwrap();
        let [stdout, stderr] = self.streams.each_ref().map(|stream| std::fs::read_to_string(stream).unwrap());
        Run { code: status.code().unwrap_or(-1), stdout, stderr }
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A recording that is whole.
pub(crate) fn recorded(path: &Path) -> Recording {
    Recording::read(BufReader::new(File::open(path).unwrap())).unwrap()
}

/// At a place, metres, turned by yaw, pitch and roll, radians.
pub(crate) fn pose(position_m: [f64; 3], turns_rad: [f64; 3]) -> Pose {
    let [yaw, pitch, roll] = turns_rad;
    Pose { position_m: position_m.into(), orientation: DQuat::from_euler(EulerRot::YXZ, yaw, pitch, roll) }
}

/// By angles to the left, right, down and up, radians.
pub(crate) fn frustum(angles_rad: [f64; 4]) -> Frustum {
    let [left, right, down, up] = angles_rad.map(f64::tan);
    Frustum { left, right, down, up, near_m: 0.001, far_m: f64::INFINITY }
}

/// Where a report leaves the volume.
pub(crate) fn stand_of(report: &Value) -> Stand {
    let stand = &report["stand"];
    let numbers = |field: &str| -> Vec<f64> { serde_json::from_value(stand[field].clone()).unwrap() };
    Stand {
        pose: Pose {
            position_m: DVec3::from_slice(&numbers("position_m")),
            orientation: DQuat::from_slice(&numbers("orientation")),
        },
        longest_side_m: stand["longest_side_m"].as_f64().unwrap(),
    }
}

/// How far two stands are apart: metres, radians, metres of the longest side; the largest of them.
pub(crate) fn distance(a: &Stand, b: &Stand) -> f64 {
    let moved = a.pose.distance_to_m(&b.pose);
    // Near no turn at all, the angle between two orientations is lost to rounding; how far their numbers are apart is not.
    let [a_turn, b_turn] = [a, b].map(|stand| stand.pose.orientation);
    let turned = 2.0 * (a_turn - b_turn).length().min((a_turn + b_turn).length());
    moved.max(turned).max((a.longest_side_m - b.longest_side_m).abs())
}
