//! What is shown, what is on its way, and what has been asked for.

use super::capture::{Capture, Subject, Turntable};
use super::command::Command;
use super::facts::Facts;
use super::job::{Progress, Waker};
use super::loading::{Arrived, Destination, Loader, Loading, Source, Step};
use super::notes::Notes;
use super::state::{Clip, Edit, State, Transfer};
use crate::failure::Failure;
use crate::output::{check_writable, unused};
use crate::text_file::read_text_file;
use crate::transfer_spec;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use wheatstone_core::transfer::Preset;
use wheatstone_io::write_atomically;
use wheatstone_render::Gpu;

/// Largest saved view that is read, bytes.
const MOST_VIEW_BYTES: u64 = 4 << 20;

/// The viewer without window and device.
pub(crate) struct Session {
    state: State,
    /// The transfer function that was chosen by its name last, unless it was edited since other than by its window.
    preset: Option<String>,
    facts: Option<Facts>,
    source: Source,
    pending: Option<Pending>,
    pub(crate) loader: Loader,
    pub(crate) notes: Notes,
    captures: Vec<Capture>,
    turntable: Option<Turntable>,
    fills_screen: bool,
    has_quit: bool,
}

/// What is to be shown of a volume that has arrived.
pub(crate) struct Showing {
    pub(crate) state: State,
    /// Name of the transfer function, if it has one.
    preset: Option<String>,
    facts: Facts,
    source: Source,
    manner: Manner,
}

impl Showing {
    /// The volume's name.
    pub(crate) fn name(&self) -> &str {
        &self.facts.name
    }
}

/// A volume that is on its way, and how it is to be shown.
struct Pending {
    source: Source,
    loading: Loading,
    manner: Manner,
}

/// How a volume is to be shown.
#[derive(Debug, Clone, PartialEq)]
enum Manner {
    /// By what suits it.
    Suiting,
    /// By a saved view.
    Saved(Box<State>),
    /// As the one before is when it arrives.
    AsBefore,
}

impl Session {
    /// Begins with a volume or a saved view on its way.
    pub(crate) fn begin(source: Source, wake: Waker, destination: Destination) -> Result<Self, Failure> {
        let source = Source { file: source.file.as_deref().map(absolute), ..source };
        let mut session = Self {
            state: State::default(),
            preset: None,
            facts: None,
            source: source.clone(),
            pending: None,
            loader: Loader::new(wake, destination),
            notes: Notes::default(),
            captures: Vec::new(),
            turntable: None,
            fills_screen: false,
            has_quit: false,
        };
        session.open_source(source)?;
        Ok(session)
    }

    /// Begins with some edits of what is shown, a saved view that is on its way included.
    pub(crate) fn edited(mut self, edits: &[Edit]) -> Result<Self, Failure> {
        let on_its_way = self.pending.as_mut().and_then(|pending| match &mut pending.manner {
            Manner::Saved(view) => Some(&mut **view),
            Manner::Suiting | Manner::AsBefore => None,
        });
        for state in std::iter::once(&mut self.state).chain(on_its_way) {
            edits.iter().try_for_each(|edit| state.apply(edit)).map_err(Failure::input)?;
        }
        Ok(self)
    }

    /// What is shown.
    pub(crate) fn state(&self) -> &State {
        &self.state
    }

    /// Name of the transfer function, as long as it is the one that was chosen by it.
    pub(crate) fn preset(&self) -> Option<&str> {
        self.preset.as_deref()
    }

    /// The volume that is shown, if there is one.
    pub(crate) fn facts(&self) -> Option<&Facts> {
        self.facts.as_ref()
    }

    /// How far a load is, if one is under way.
    pub(crate) fn progress(&self) -> Option<Progress> {
        self.pending.as_ref().map(|pending| pending.loading.progress())
    }

    /// Whether the window is to fill the whole screen.
    pub(crate) fn fills_screen(&self) -> bool {
        self.fills_screen
    }

    /// Whether the program is to end.
    pub(crate) fn has_quit(&self) -> bool {
        self.has_quit
    }

    /// Whether pictures are still to be written.
    pub(crate) fn is_capturing(&self) -> bool {
        !self.captures.is_empty() || self.turntable.is_some()
    }

    /// Does what it is told; what fails is noted and changes nothing.
    pub(crate) fn perform(&mut self, command: &Command) {
        if let Err(failure) = self.try_perform(command) {
            self.notes.failed(failure.to_string());
        }
    }

    /// Goes on with a load, for a headset by a step that takes no longer than a time, as far as is known; what has arrived is to be
    /// prepared, then shown or refused.
    pub(crate) fn step(&mut self, gpu: &Arc<Gpu>, time: Duration) -> Option<(Box<Arrived>, Showing)> {
        let Pending { source, loading, manner } = self.pending.take()?;
        let step = self.loader.step(loading, gpu, time).and_then(|step| match step {
            Step::UnderWay(loading) => {
                self.pending = Some(Pending { source, loading, manner });
                Ok(None)
            }
            Step::Done(arrived) => {
                let showing = self.showing(source, manner, arrived.facts.clone())?;
                Ok(Some((arrived, showing)))
            }
        });
        step.unwrap_or_else(|failure| {
            self.refuse(&failure);
            None
        })
    }

    /// The same, with all that has been edited since.
    pub(crate) fn renewed(&self, showing: Showing) -> Result<Showing, Failure> {
        self.showing(showing.source, showing.manner, showing.facts)
    }

    /// A volume that has arrived is shown from now on.
    pub(crate) fn show(&mut self, showing: Showing) {
        for warning in &showing.facts.warnings {
            self.notes.warn(format!("{}: {warning}", showing.facts.name));
        }
        self.notes.done(format!("showing {}", showing.facts.name));
        self.state = showing.state;
        self.preset = showing.preset;
        self.source = showing.source;
        self.facts = Some(showing.facts);
    }

    /// A volume cannot be shown; what is shown stays.
    pub(crate) fn refuse(&mut self, failure: &Failure) {
        self.notes.failed(failure.to_string());
        if self.facts.is_none() {
            self.captures.clear();
            self.turntable = None;
        }
    }

    /// Takes the pictures that are due by something that writes them; those of a picture at rest only if it is.
    pub(crate) fn capture(
        &mut self,
        is_at_rest: bool,
        mut write: impl FnMut(&Capture) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        for capture in self.take_captures(is_at_rest) {
            if self.notes.survive(write(&capture))?.is_some() {
                self.notes.done(format!("wrote {}", capture.path.display()));
            }
        }
        Ok(())
    }

    fn take_captures(&mut self, is_at_rest: bool) -> Vec<Capture> {
        if is_at_rest && self.captures.is_empty() {
            let next = self.turn();
            self.captures.extend(next);
        }
        let (now, later) = std::mem::take(&mut self.captures)
            .into_iter()
            .partition(|capture| is_at_rest || capture.subject == Subject::Window);
        self.captures = later;
        now
    }

    /// The next picture of a turn, if the camera is where it is to be taken from; else brings it there.
    fn turn(&mut self) -> Option<Capture> {
        let turntable = self.turntable.as_mut()?;
        let start = *turntable.start.get_or_insert(self.state.camera);
        let camera = start.orbited(turntable.turned_deg());
        if self.state.camera != camera {
            self.state.camera = camera;
            return None;
        }
        let capture = turntable.next_shot();
        self.state.camera = start.orbited(turntable.turned_deg());
        if turntable.is_over() {
            self.turntable = None;
        }
        capture
    }

    /// Does what it is told; what fails changes nothing.
    pub(crate) fn try_perform(&mut self, command: &Command) -> Result<(), Failure> {
        match command {
            Command::Edit(edit) => self.edit(edit),
            Command::Open(path) => self.open(path),
            Command::Drop(paths) => self.open_first(paths),
            Command::OpenShipped => self.load(Source { file: None, layout: None }, Manner::Suiting),
            Command::Reload => self.reload(),
            Command::Save(path) => self.save(path),
            Command::SaveNew(path) => self.save(&unused(path, |_| false)),
            Command::Picture(path) => {
                self.expect_volume()?;
                self.note_capture(Subject::Picture, path)
            }
            Command::Screenshot(path) => self.note_capture(Subject::Window, path),
            Command::ScreenshotNew(path) => {
                let is_wanted = |path: &Path| self.captures.iter().any(|capture| capture.path == path);
                let path = unused(path, is_wanted);
                self.note_capture(Subject::Window, &path)
            }
            Command::Turntable { pictures, path } => self.begin_turn(*pictures, path),
            Command::Preset(name) => self.choose_preset(name),
            Command::FullScreen => {
                self.fills_screen = !self.fills_screen;
                Ok(())
            }
            Command::Quit => {
                self.has_quit = true;
                Ok(())
            }
        }
    }

    fn edit(&mut self, edit: &Edit) -> Result<(), Failure> {
        let before = self.state.transfer.clone();
        self.state.apply(edit).map_err(Failure::input)?;
        let window = self.state.transfer.window;
        if (Transfer { window, ..before }) != self.state.transfer {
            self.preset = None;
        }
        Ok(())
    }

    /// Refuses what needs a volume if there is none and none is on its way.
    fn expect_volume(&self) -> Result<(), Failure> {
        if self.facts.is_some() || self.pending.is_some() {
            Ok(())
        } else {
            Err(Failure::input("no volume is shown"))
        }
    }

    fn note_capture(&mut self, subject: Subject, path: &Path) -> Result<(), Failure> {
        check_writable(path, "png")?;
        self.captures.push(Capture { subject, path: path.to_owned() });
        Ok(())
    }

    fn begin_turn(&mut self, pictures: u32, path: &Path) -> Result<(), Failure> {
        self.expect_volume()?;
        if let Some(turntable) = &self.turntable {
            return Err(Failure::input(format!(
                "{turntable} is still being made: wait until it is complete"
            )));
        }
        check_writable(path, "png")?;
        // What a saved view that is on its way begins with is not known yet.
        let start = self.pending.is_none().then_some(self.state.camera);
        self.turntable = Some(Turntable::new(pictures, path.to_owned(), start).map_err(Failure::input)?);
        Ok(())
    }

    fn open(&mut self, path: &Path) -> Result<(), Failure> {
        let path = absolute(path);
        if !is_view(&path) {
            return self.load(Source { file: Some(path), layout: None }, Manner::Suiting);
        }
        let mut view = read_text_file(&path, MOST_VIEW_BYTES, "a saved view", State::from_json)?;
        view.file = view.file.map(|file| volume_of_view(&path, &file));
        let source = Source { file: view.file.clone(), layout: view.layout.clone() };
        if self.facts.is_some() && self.pending.is_none() && source == self.source {
            (self.state, self.preset) = (view, None);
            return Ok(());
        }
        self.load(source, Manner::Saved(Box::new(view)))
    }

    /// Opens a saved view, or a volume that may be named like one if its layout is given.
    fn open_source(&mut self, source: Source) -> Result<(), Failure> {
        match &source.file {
            Some(file) if is_view(file) && source.layout.is_none() => self.open(file),
            _ => self.load(source, Manner::Suiting),
        }
    }

    /// Reads the volume that is shown again, or else the first one.
    fn reload(&mut self) -> Result<(), Failure> {
        match self.pending.take() {
            _ if self.facts.is_some() => self.load(self.source.clone(), Manner::AsBefore),
            Some(Pending { source, manner, .. }) => self.load(source, manner),
            None => self.open_source(self.source.clone()),
        }
    }

    fn open_first(&mut self, paths: &[PathBuf]) -> Result<(), Failure> {
        let Some((first, others)) = paths.split_first() else { return Ok(()) };
        if !others.is_empty() {
            let name = first.file_name().unwrap_or(first.as_os_str()).display();
            self.notes.done(format!(
                "{name} alone is opened, not the {} other files: slices are not put together",
                others.len()
            ));
        }
        self.open(first)
    }

    fn load(&mut self, source: Source, manner: Manner) -> Result<(), Failure> {
        // The load before is given up.
        self.pending = None;
        let loading = self.loader.begin(source.clone())?;
        self.pending = Some(Pending { source, loading, manner });
        Ok(())
    }

    fn showing(&self, source: Source, manner: Manner, facts: Facts) -> Result<Showing, Failure> {
        let (state, preset) = match &manner {
            Manner::Saved(view) => ((**view).clone(), None),
            Manner::AsBefore => (self.state.clone(), self.preset.clone()),
            Manner::Suiting => {
                let suiting = suiting(&source);
                let clip = Clip { has_handles: self.state.clip.has_handles, ..Clip::default() };
                let mut state = self.state.clone();
                (state.file, state.layout) = (source.file.clone(), source.layout.clone());
                (state.transfer, state.clip) =
                    (facts.transfer(&transfer_spec::parse(suiting).map_err(Failure::input)?)?, clip);
                (state, Some(suiting.to_owned()))
            }
        };
        Ok(Showing { state, preset, facts, source, manner })
    }

    fn save(&mut self, path: &Path) -> Result<(), Failure> {
        check_writable(path, "json")?;
        let mut view = self.state.clone();
        view.file = view.file.map(|file| name_in_view(path, &file));
        let text = view.to_json().map_err(Failure::input)?;
        write_atomically(path, |writer| writer.write_all(text.as_bytes()))?;
        self.notes.done(format!("saved {}", path.display()));
        Ok(())
    }

    fn choose_preset(&mut self, name: &str) -> Result<(), Failure> {
        let facts = self.facts.as_ref().ok_or_else(|| Failure::input("no volume is shown yet"))?;
        let transfer = facts.transfer(&transfer_spec::parse(name).map_err(Failure::input)?)?;
        self.state.apply(&Edit::Transfer(transfer)).map_err(Failure::input)?;
        self.preset = Some(name.to_owned());
        Ok(())
    }
}

fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// The volume file that a saved view names: in the view's folder, or else where the program runs.
fn volume_of_view(view: &Path, file: &Path) -> PathBuf {
    let beside = view.with_file_name(file);
    let here = absolute(file);
    if !beside.exists() && here.exists() { here } else { beside }
}

/// How a saved view names a volume file: from the view's folder if it is there or below.
fn name_in_view(view: &Path, file: &Path) -> PathBuf {
    let view = absolute(view);
    let from_folder = view.parent().and_then(|folder| file.strip_prefix(folder).ok());
    from_folder.unwrap_or(file).to_owned()
}

/// Whether a path names a saved view.
fn is_view(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// Name of the transfer function that a volume is shown with at first.
fn suiting(source: &Source) -> &'static str {
    match source.file {
        None => Preset::MriBrainT1.name(),
        Some(_) => "auto",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::Camera;
    use wheatstone_core::volume::{Grid, Volume, Voxels};
    use wheatstone_render::GpuError;

    #[test]
    fn a_session_begins_with_an_absolute_path() {
        let source = Source { file: Some("missing.nrrd".into()), layout: None };
        let session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        assert!(session.pending.unwrap().source.file.unwrap().is_absolute());
    }

    #[test]
    fn edits_at_the_beginning_hold_for_a_saved_view_too() {
        let folder = tempfile::tempdir().unwrap();
        let view = folder.path().join("view.json");
        std::fs::write(&view, State::default().to_json().unwrap()).unwrap();
        let source = Source { file: Some(view), layout: None };
        let session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        let session = session.edited(&[Edit::Refresh(Some(17.0))]).unwrap();
        assert_eq!(session.state.pace.refresh_ms, Some(17.0));
        let Manner::Saved(view) = session.pending.unwrap().manner else { panic!("a saved view") };
        assert_eq!(view.pace.refresh_ms, Some(17.0));
    }

    #[test]
    fn of_files_dropped_together_the_first_is_opened_and_the_others_are_told_of() {
        let source = Source { file: Some("missing.nrrd".into()), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        session.perform(&Command::Drop(vec!["a.dcm".into(), "b.dcm".into(), "c.dcm".into()]));
        assert!(session.pending.as_ref().unwrap().source.file.as_ref().unwrap().ends_with("a.dcm"));
        let told = &session.notes.latest()[0].text;
        assert!(told.contains("a.dcm") && told.contains("2 other files"), "{told}");
        session.perform(&Command::Drop(vec!["b.dcm".into()]));
        assert_eq!(session.notes.latest().len(), 1);
    }

    #[test]
    fn a_volume_that_is_refused_leaves_everything_as_it_was() {
        let source = Source { file: None, layout: None };
        let mut session = Session::begin(source.clone(), Arc::new(|| ()), Destination::Window).unwrap();
        let facts = facts_of("b.nrrd");
        let arrives = |session: &Session| {
            let source = Source { file: Some("b.nrrd".into()), layout: None };
            session.showing(source, Manner::Suiting, facts.clone()).unwrap()
        };
        let before = session.state.clone();
        let _ = arrives(&session);
        session.refuse(&Failure::input("no memory for b.nrrd"));
        assert_eq!((&session.state, &session.source), (&before, &source));
        assert!(session.facts.is_none() && session.notes.failures()[0].contains("no memory"));
        session.show(arrives(&session));
        assert!(session.facts.is_some() && session.state.file == session.source.file);
        assert_ne!(session.state, before);
    }

    fn facts_of(name: &str) -> Facts {
        let grid = Grid::centred([2, 2, 2], [1.0; 3]).unwrap();
        let volume = Volume::new(grid, Voxels::U8((0..8).collect())).unwrap();
        Facts::of(&volume, Some(Path::new(name)))
    }

    /// A session that shows `a.nrrd`, which is not there, of a folder.
    fn showing_a(folder: &Path) -> Session {
        let source = Source { file: Some(folder.join("a.nrrd")), layout: None };
        let mut session = Session::begin(source.clone(), Arc::new(|| ()), Destination::Window).unwrap();
        session.pending = None;
        session.show(session.showing(source, Manner::Suiting, facts_of("a.nrrd")).unwrap());
        session
    }

    /// What is on its way arrives.
    fn arrive(session: &mut Session) -> Showing {
        let Pending { source, manner, .. } = session.pending.take().unwrap();
        session.showing(source, manner, facts_of("a.nrrd")).unwrap()
    }

    #[test]
    fn a_reload_keeps_what_is_edited_while_it_is_under_way_until_it_is_shown() {
        let mut session = showing_a(Path::new("/nowhere"));
        session.perform(&Command::Reload);
        session.perform(&Edit::Zoom(2.0).into());
        session.perform(&Command::Preset("viridis".to_owned()));
        let showing = arrive(&mut session);
        session.perform(&Edit::Isovalue(0.25).into());
        let before = session.state.clone();
        session.show(session.renewed(showing).unwrap());
        assert_eq!((&session.state, session.preset()), (&before, Some("viridis")));
        assert!(before.look.isovalue == 0.25 && before.camera != Camera::default());
    }

    #[test]
    fn a_reload_before_anything_is_shown_begins_again_in_the_same_manner() {
        let folder = tempfile::tempdir().unwrap();
        let view = folder.path().join("view.json");
        let mut saved = State::default();
        saved.file = Some("a.nrrd".into());
        std::fs::write(&view, saved.to_json().unwrap()).unwrap();
        let source = Source { file: Some(view), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        for _ in 0..2 {
            session.perform(&Command::Reload);
            let pending = session.pending.as_ref().unwrap();
            assert!(
                matches!(pending.manner, Manner::Saved(_))
                    && pending.source.file == Some(folder.path().join("a.nrrd"))
            );
            // As if it had failed.
            session.pending = None;
        }
    }

    #[test]
    fn however_often_a_file_is_read_again_one_load_is_at_work() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a_256x256x256_uint8.raw");
        std::fs::File::create(&file).unwrap().set_len(1 << 24).unwrap();
        let source = Source { file: Some(file), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        for _ in 0..100 {
            session.perform(&Command::Reload);
            assert!(session.loader.loads_at_work() <= 1);
        }
        assert!(session.pending.is_some() && session.notes.failures().is_empty());
    }

    #[test]
    fn what_the_reader_assumed_is_told() {
        let mut session = showing_a(Path::new("/nowhere"));
        let facts = facts_of("b.nrrd").with_warnings(vec!["only the first frame".to_owned()]);
        session.show(session.showing(session.source.clone(), Manner::Suiting, facts).unwrap());
        let told: Vec<_> = session.notes.latest().iter().map(|note| note.text.clone()).collect();
        assert!(told.contains(&"b.nrrd: only the first frame".to_owned()), "{told:?}");
        assert!(session.notes.failures().is_empty());
    }

    #[test]
    fn a_preset_is_told_as_long_as_its_function_is_shown() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = showing_a(folder.path());
        let view = folder.path().join("view.json");
        session.perform(&Command::Save(view.clone()));
        session.perform(&Command::Preset("viridis".to_owned()));
        session.perform(&Edit::WindowLevel { shift: 0.1, stretch: 1.0 }.into());
        assert_eq!(session.preset(), Some("viridis"));
        session.perform(&Edit::AddOpacityPoint([0.5, 0.5]).into());
        assert_eq!(session.preset(), None);
        session.perform(&Command::Preset("viridis".to_owned()));
        session.perform(&Command::Open(view));
        assert!(session.pending.is_none() && session.preset().is_none());
    }

    #[test]
    fn a_saved_view_names_its_volume_from_its_own_folder() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        for (volume, view, named) in [
            ("a.nrrd", "view.json", Path::new("a.nrrd")),
            ("sub/a.nrrd", "view.json", Path::new("sub/a.nrrd")),
            ("a.nrrd", "sub/view.json", &path("a.nrrd")),
        ] {
            std::fs::write(path(volume), []).unwrap();
            let mut session = showing_a(path(volume).parent().unwrap());
            session.perform(&Command::Save(path(view)));
            let text = std::fs::read_to_string(path(view)).unwrap();
            assert_eq!(State::from_json(&text).unwrap().file.unwrap(), named);
            assert_eq!(session.state.file, Some(path(volume)), "what is shown stays as it is");
            session.perform(&Edit::Zoom(2.0).into());
            session.perform(&Command::Open(path(view)));
            assert!(session.pending.is_none(), "the volume that is shown is that of the view");
            assert_eq!(session.state.file, Some(path(volume)));
        }
    }

    #[test]
    fn a_volume_is_looked_for_beside_the_view_then_where_the_program_runs() {
        let folder = tempfile::tempdir().unwrap();
        let view = folder.path().join("view.json");
        // Tests run in the folder of their package.
        let here = Path::new("Cargo.toml");
        assert_eq!(volume_of_view(&view, here), std::env::current_dir().unwrap().join(here));
        std::fs::write(folder.path().join(here), []).unwrap();
        assert_eq!(volume_of_view(&view, here), folder.path().join(here));
        assert_eq!(volume_of_view(&view, Path::new("b.nrrd")), folder.path().join("b.nrrd"));
        assert_eq!(volume_of_view(&view, Path::new("/x/b.nrrd")), Path::new("/x/b.nrrd"));
    }

    #[test]
    fn a_turn_keeps_its_own_start_and_no_other_begins_before_its_end() {
        let folder = tempfile::tempdir().unwrap();
        let mut session = showing_a(folder.path());
        let start = session.state.camera;
        let turn = |name: &str| Command::Turntable { pictures: 4, path: folder.path().join(name) };
        session.perform(&turn("a.png"));
        session.perform(&turn("b.png"));
        let refusal = session.notes.failures().last().unwrap().clone();
        assert!(refusal.contains("a.png") && refusal.contains("wait"), "{refusal}");
        session.perform(&Edit::Orbit { right_deg: 5.0, up_deg: 3.0 }.into());
        let mut taken = Vec::new();
        for refresh in 0..20 {
            let camera = session.state.camera;
            let write = |capture: &Capture| {
                taken.push((capture.path.clone(), camera));
                Ok(())
            };
            session.capture(true, write).unwrap();
            if refresh % 3 == 0 {
                session.perform(&Edit::Zoom(1.1).into());
            }
        }
        assert!(!session.is_capturing());
        for (index, (path, camera)) in taken.iter().enumerate() {
            assert_eq!(path, &folder.path().join(format!("a_{index:04}.png")));
            assert_eq!(*camera, start.orbited(90.0 * index as f64));
        }
        assert_eq!(taken.len(), 4);
        session.perform(&turn("b.png"));
        assert!(session.is_capturing());
    }

    #[test]
    fn keys_save_by_names_that_are_free_and_commands_by_theirs() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let mut session = showing_a(folder.path());
        for _ in 0..2 {
            session.perform(&Command::SaveNew(path("view.json")));
            session.perform(&Command::Save(path("same.json")));
            session.perform(&Command::ScreenshotNew(path("shot.png")));
        }
        assert!(["view.json", "view-2.json", "same.json"].iter().all(|name| path(name).exists()));
        assert!(!path("same-2.json").exists());
        let captures: Vec<_> = session.captures.iter().map(|capture| capture.path.clone()).collect();
        assert_eq!(captures, [path("shot.png"), path("shot-2.png")], "none of them is written yet");
    }

    #[test]
    fn a_screenshot_is_taken_at_once_a_picture_at_rest_and_what_cannot_be_written_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let [window, picture] = ["a.png", "b.png"].map(|name| folder.path().join(name));
        let source = Source { file: Some("missing.nrrd".into()), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Headset).unwrap();
        session.perform(&Command::Screenshot(window.clone()));
        session.perform(&Command::Picture(picture.clone()));
        let mut taken = Vec::new();
        for is_at_rest in [false, true] {
            let write = |capture: &Capture| {
                taken.push((is_at_rest, capture.path.clone()));
                if capture.subject == Subject::Window { Ok(()) } else { Err(Failure::input("no room")) }
            };
            session.capture(is_at_rest, write).unwrap();
        }
        assert_eq!(taken, [(false, window), (true, picture)]);
        assert!(!session.is_capturing() && session.notes.latest()[0].text.contains("a.png"));
        assert_eq!(session.notes.failures(), ["no room"]);
        session.perform(&Command::Screenshot(folder.path().join("c.png")));
        let is_gone = |_: &Capture| Err(Failure::Gpu(GpuError::Hung { seconds: 1 }));
        assert!(session.capture(false, is_gone).is_err());
    }

    #[test]
    fn pictures_of_nothing_are_refused_and_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Command::Picture(folder.path().join("a.png"));
        let source = Source { file: Some("missing.nrrd".into()), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Window).unwrap();
        session.perform(&picture);
        assert!(session.is_capturing());
        session.pending = None;
        session.refuse(&Failure::input("missing"));
        assert!(!session.is_capturing());
        session.perform(&picture);
        session.perform(&Command::Turntable { pictures: 2, path: folder.path().join("t.png") });
        assert!(!session.is_capturing());
        assert!(session.notes.failures().last().unwrap().contains("no volume"));
    }
}
