//! Monado, and tests that run with its libraries.
//!
//! Monado, its client library and its drivers need newer system libraries than the machine may have. So a test starts the service, and then
//! itself once more, both by the dynamic loader that belongs to them; what it is to show happens in that second process.

use crate::remote::Remote;
use crate::screenshot::Screenshot;
use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{BufRead as _, BufReader};
use std::net::TcpListener;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::net::UnixStream;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;
use tempfile::TempDir;

/// Where Monado is.
const MONADO: &str = "WHEATSTONE_MONADO";
/// Why there is none.
const SKIPPED: &str = "WHEATSTONE_SKIP_XR_TESTS";
/// Set in the second process.
const INSIDE: &str = "WHEATSTONE_XR_INSIDE";
const PORT: &str = "WHEATSTONE_XR_PORT";
const SERVICE: &str = "WHEATSTONE_XR_SERVICE";
/// Where a program's complaints go.
const LOG: &str = "WHEATSTONE_XR_LOG";
/// Set in a further process.
const SECOND: &str = "WHEATSTONE_XR_SECOND";
/// What is on the display.
const SCREEN: &str = "WHEATSTONE_XR_SCREEN";

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

/// What a test runs in.
pub(crate) struct Surroundings {
    pub(crate) compositor: Compositor,
    /// Further environment of the second process.
    pub(crate) environment: Vec<(&'static str, OsString)>,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self { compositor: Compositor::Null, environment: Vec::new() }
    }
}

/// The service, as the test sees it.
pub(crate) struct Monado {
    port: u16,
    service: u32,
}

impl Monado {
    /// Devices that the test moves.
    pub(crate) fn remote(&self) -> Remote {
        Remote::connect(self.port)
    }

    /// What is on the display.
    pub(crate) fn screen(&self) -> Screenshot {
        Screenshot::of(&std::fs::read(std::env::var_os(SCREEN).unwrap()).unwrap())
    }

    /// Starts the test's body once more, as another program.
    pub(crate) fn second(&self) -> Child {
        let own = std::fs::read("/proc/self/cmdline").unwrap();
        let mut words = own.split(|byte| *byte == 0).map(OsStr::from_bytes).filter(|word| !word.is_empty());
        Command::new(words.next().unwrap())
            .args(words)
            .env(SECOND, "1")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    }

    /// Whether this is that other program.
    pub(crate) fn is_second(&self) -> bool {
        std::env::var_os(SECOND).is_some()
    }

    /// Ends the service as a crash would.
    pub(crate) fn kill(&self) {
        assert!(Command::new("kill").args(["-9", &self.service.to_string()]).status().unwrap().success());
    }
}

/// Runs a test's body with Monado.
pub(crate) fn inside<Test>(test: Test, body: impl FnOnce(&Monado)) -> Option<String> {
    inside_with(test, Surroundings::default(), body)
}

/// Runs a test's body in a second process, with Monado's libraries. Returns what that process wrote; nothing where it is skipped, and in
/// the second process.
pub(crate) fn inside_with<Test>(
    _: Test,
    surroundings: Surroundings,
    body: impl FnOnce(&Monado),
) -> Option<String> {
    if std::env::var_os(INSIDE).is_some() {
        let number = |name| std::env::var(name).map_or(0, |value| value.parse().unwrap());
        body(&Monado { port: u16::try_from(number(PORT)).unwrap(), service: number(SERVICE) });
        return None;
    }
    let prefix = match prefix() {
        Ok(prefix) => prefix,
        Err(reason) => {
            eprintln!("skipped: {reason}");
            return None;
        }
    };
    let _turn = ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner);
    let (_, path) = std::any::type_name::<Test>().split_once("::").unwrap();
    Some(run(&prefix, path, surroundings))
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

fn run(prefix: &Path, test: &str, surroundings: Surroundings) -> String {
    let home = tempfile::Builder::new().prefix("monado-").tempdir().unwrap();
    let display = (surroundings.compositor == Compositor::Screen).then(|| Display::start(&home));
    let service = (surroundings.compositor != Compositor::None)
        .then(|| Service::start(prefix, &home, display.as_ref()));
    let mut command = by_own_loader(prefix, &home, &std::env::current_exe().unwrap());
    command.args([test, "--exact", "--nocapture", "--test-threads=1"]).env(INSIDE, "1");
    if let Some(service) = &service {
        command.env(PORT, service.port.to_string()).env(SERVICE, service.kept.process.to_string());
    }
    if let Some(display) = &display {
        command.env(SCREEN, &display.screen);
    }
    command.envs(surroundings.environment);
    let output = command.stdin(Stdio::null()).output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    let log = std::fs::read_to_string(home.path().join("service.log")).unwrap_or_default();
    assert!(
        output.status.success() && out.contains("1 passed"),
        "{test}: {}\n{out}\n{err}\n-- service --\n{log}",
        output.status
    );
    format!("{out}\n{err}")
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
