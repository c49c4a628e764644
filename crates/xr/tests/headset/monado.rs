//! Monado: its service, with devices that the test moves, and programs that run with its libraries.
//!
//! Monado, its client library and its drivers need newer system libraries than the machine may have. So what talks to it is started by
//! the dynamic loader that belongs to them.

use crate::remote::Remote;
use crate::screenshot::Screenshot;
use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tempfile::TempDir;

/// Where Monado is.
const MONADO: &str = "WHEATSTONE_MONADO";
/// Why there is none.
const SKIPPED: &str = "WHEATSTONE_SKIP_XR_TESTS";
/// Where a program's complaints go.
const LOG: &str = "WHEATSTONE_XR_LOG";

/// Runs a program, and ends it when it is told to or when whoever started it is gone: then its standard input ends.
const KEEPER: &str =
    r#"exec 3<&0; "$@" </dev/null & pid=$!; echo $pid; (read -r _ <&3; kill -9 $pid) & wait $pid"#;

/// One after the other: they share two cores with the compositor.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

/// What the service does with pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Compositor {
    /// There is no service.
    None,
    /// It takes them and shows nothing.
    Null,
    /// It shows them on a display without a screen.
    Screen,
}

/// Monado as it runs; it ends with this.
pub(crate) struct Monado {
    service: Option<Service>,
    display: Option<Display>,
    home: TempDir,
    prefix: PathBuf,
    _turn: MutexGuard<'static, ()>,
}

/// The service, as a test sees it.
#[derive(Debug, Clone)]
pub(crate) struct Contact {
    /// Where the remote driver listens; 0 without a service.
    pub(crate) port: u16,
    /// Its process; 0 without a service.
    pub(crate) service: u32,
    /// The file that holds what is on the display.
    pub(crate) screen: Option<PathBuf>,
}

impl Monado {
    /// Starts it once no other test has it. Tells why there is none, and that the test is skipped.
    pub(crate) fn start(compositor: Compositor) -> Option<Self> {
        let prefix = match prefix() {
            Ok(prefix) => prefix,
            Err(reason) => {
                eprintln!("skipped: {reason}");
                return None;
            }
        };
        let turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
        let home = tempfile::Builder::new().prefix("monado-").tempdir().unwrap();
        let display = (compositor == Compositor::Screen).then(|| Display::start(&home));
        let service =
            (compositor != Compositor::None).then(|| Service::start(&prefix, &home, display.as_ref()));
        Some(Self { service, display, home, prefix, _turn: turn })
    }

    /// A program with its libraries, that finds it.
    pub(crate) fn command(&self, program: &Path) -> Command {
        by_own_loader(&self.prefix, &self.home, program)
    }

    /// What is to be known to talk to it.
    pub(crate) fn contact(&self) -> Contact {
        let service = self.service.as_ref();
        Contact {
            port: service.map_or(0, |service| service.port),
            service: service.map_or(0, |service| service.kept.process),
            screen: self.display.as_ref().map(|display| display.screen.clone()),
        }
    }

    /// What the service has said.
    pub(crate) fn log(&self) -> String {
        std::fs::read_to_string(self.home.path().join("service.log")).unwrap_or_default()
    }
}

impl Contact {
    /// Devices that the test moves.
    pub(crate) fn remote(&self) -> Remote {
        Remote::connect(self.port)
    }

    /// What is on the display.
    pub(crate) fn screen(&self) -> Screenshot {
        Screenshot::of(&std::fs::read(self.screen.as_ref().unwrap()).unwrap())
    }

    /// Ends the service as a crash would.
    pub(crate) fn kill(&self) {
        assert!(Command::new("kill").args(["-9", &self.service.to_string()]).status().unwrap().success());
    }
}

/// The folder that `scripts/monado.sh` has made, or why there is none.
fn prefix() -> Result<PathBuf, String> {
    if let Some(prefix) = std::env::var_os(MONADO) {
        return Ok(prefix.into());
    }
    if let Ok(reason) = std::env::var(SKIPPED) {
        return Err(reason);
    }
    let cache = std::env::var_os("XDG_CACHE_HOME").map_or_else(
        || PathBuf::from(std::env::var_os("HOME").unwrap_or_default()).join(".cache"),
        PathBuf::from,
    );
    let prefix = cache.join("wheatstone/monado");
    assert!(
        prefix.join("layout").exists(),
        "no Monado in {}: run scripts/monado.sh, or say in {SKIPPED} why these tests are skipped",
        prefix.display()
    );
    Ok(prefix)
}

/// A program under the dynamic loader and with the libraries of a prefix.
fn by_own_loader(prefix: &Path, home: &TempDir, program: &Path) -> Command {
    let libraries = std::fs::read_to_string(prefix.join("library-path")).unwrap();
    let mut command = Command::new(prefix.join("loader"));
    command
        .args(["--library-path", libraries.trim()])
        .arg(program)
        .env("HOME", home.path())
        .env("XDG_RUNTIME_DIR", home.path())
        .env("XDG_CONFIG_HOME", home.path())
        .env("XR_RUNTIME_JSON", prefix.join("runtime.json"))
        .env("VK_DRIVER_FILES", prefix.join("vulkan.json"))
        .env("VK_LAYER_PATH", prefix.join("layers"));
    command
}

/// A program that ends with this.
struct Kept {
    keeper: Child,
    /// Its process.
    process: u32,
    /// What it says.
    said: BufReader<ChildStdout>,
}

impl Kept {
    fn start(program: &Command) -> Self {
        let mut command = Command::new("sh");
        command.args(["-c", KEEPER, "sh"]).arg(program.get_program()).args(program.get_args());
        command.envs(program.get_envs().filter_map(|(name, value)| Some((name, value?))));
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        if let Some(log) = program.get_envs().find_map(|(name, value)| value.filter(|_| name == LOG)) {
            command.stderr(File::create(log).unwrap());
        }
        let mut keeper = command.spawn().unwrap();
        let said = BufReader::new(keeper.stdout.take().unwrap());
        let mut kept = Self { keeper, process: 0, said };
        kept.process = kept.line().parse().unwrap();
        kept
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.said.read_line(&mut line).unwrap();
        line.trim().to_owned()
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        drop(self.keeper.stdin.take());
        self.keeper.wait().unwrap();
    }
}

/// A service of its own for each test.
struct Service {
    kept: Kept,
    port: u16,
}

impl Service {
    fn start(prefix: &Path, home: &TempDir, display: Option<&Display>) -> Self {
        let port = TcpListener::bind(("127.0.0.1", 0)).unwrap().local_addr().unwrap().port();
        let settings = home.path().join("monado");
        std::fs::create_dir(&settings).unwrap();
        let remote = format!(r#"{{"version": 0, "port": {port}, "view_count": 2}}"#);
        let active = format!(r#"{{"active": "remote", "remote": {remote}}}"#);
        std::fs::write(settings.join("config_v0.json"), active).unwrap();
        let log = home.path().join("service.log");
        let mut service = by_own_loader(prefix, home, &prefix.join("root/usr/bin/monado-service"));
        service.env(LOG, &log).env("XRT_NO_STDIN", "1").env("P_OVERRIDE_ACTIVE_CONFIG", "remote");
        match display {
            Some(display) => service.env("XRT_COMPOSITOR_FORCE_XCB", "1").env("DISPLAY", &display.name),
            None => service.env("XRT_COMPOSITOR_NULL", "1"),
        };
        let mut kept = Kept::start(&service);
        while UnixStream::connect(home.path().join("monado_comp_ipc")).is_err() {
            let ended = kept.keeper.try_wait().unwrap();
            let log = || std::fs::read_to_string(&log).unwrap_or_default();
            assert!(ended.is_none(), "the service ended: {}", log());
            std::thread::sleep(Duration::from_millis(10));
        }
        Self { kept, port }
    }
}

/// A display without a screen, as large as the window that the service makes for its devices.
struct Display {
    /// Ends with this.
    _kept: Kept,
    name: String,
    /// The file that holds what is on it.
    screen: PathBuf,
}

impl Display {
    fn start(home: &TempDir) -> Self {
        let mut server = Command::new("Xvfb");
        server.args(["-displayfd", "1", "-screen", "0", "960x540x24", "-nolisten", "tcp", "-fbdir"]);
        server.arg(home.path()).env(LOG, home.path().join("display.log"));
        let mut kept = Kept::start(&server);
        let number = kept.line();
        assert!(!number.is_empty(), "Xvfb gives no display: is it installed?");
        let name = format!(":{number}");
        Self { _kept: kept, name, screen: home.path().join("Xvfb_screen0") }
    }
}
