//! Tests that run with Monado's libraries: a test starts itself once more, and what it is to show happens in that second process.

use crate::monado::{Compositor, Contact, Monado};
use std::ffi::{OsStr, OsString};
use std::ops::Deref;
use std::os::unix::ffi::OsStrExt as _;
use std::process::{Child, Command, Stdio};

/// Set in the second process.
const INSIDE: &str = "WHEATSTONE_XR_INSIDE";
const PORT: &str = "WHEATSTONE_XR_PORT";
const SERVICE: &str = "WHEATSTONE_XR_SERVICE";
/// Set in a further process.
const SECOND: &str = "WHEATSTONE_XR_SECOND";
/// What is on the display.
const SCREEN: &str = "WHEATSTONE_XR_SCREEN";

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

/// Monado, as seen from the second process.
pub(crate) struct Inside(Contact);

impl Deref for Inside {
    type Target = Contact;

    fn deref(&self) -> &Contact {
        &self.0
    }
}

impl Inside {
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
}

/// Runs a test's body with Monado.
pub(crate) fn inside<Test>(test: Test, body: impl FnOnce(&Inside)) -> Option<String> {
    inside_with(test, Surroundings::default(), body)
}

/// Runs a test's body in a second process, with Monado's libraries. Returns what that process wrote; nothing where it is skipped, and in
/// the second process.
pub(crate) fn inside_with<Test>(
    _: Test,
    surroundings: Surroundings,
    body: impl FnOnce(&Inside),
) -> Option<String> {
    if std::env::var_os(INSIDE).is_some() {
        let number = |name| std::env::var(name).unwrap().parse::<u32>().unwrap();
        body(&Inside(Contact {
            port: u16::try_from(number(PORT)).unwrap(),
            service: number(SERVICE),
            screen: std::env::var_os(SCREEN).map(Into::into),
        }));
        return None;
    }
    let monado = Monado::start(surroundings.compositor)?;
    let (_, path) = std::any::type_name::<Test>().split_once("::").unwrap();
    Some(run(&monado, path, surroundings.environment))
}

fn run(monado: &Monado, test: &str, environment: Vec<(&'static str, OsString)>) -> String {
    let contact = monado.contact();
    let mut command = monado.command(&std::env::current_exe().unwrap());
    command.args([test, "--exact", "--nocapture", "--test-threads=1"]).env(INSIDE, "1");
    command.env(PORT, contact.port.to_string()).env(SERVICE, contact.service.to_string());
    command.envs(contact.screen.map(|screen| (SCREEN, screen))).envs(environment);
    let output = command.stdin(Stdio::null()).output().unwrap();
    let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    assert!(
        output.status.success() && out.contains("1 passed"),
        "{test}: {}\n{out}\n{err}\n-- service --\n{}",
        output.status,
        monado.log()
    );
    format!("{out}\n{err}")
}
