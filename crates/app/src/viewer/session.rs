//! What is shown, what is on its way, and what has been asked for.

use super::capture::{Capture, Subject, Turntable};
use super::command::Command;
use super::facts::Facts;
use super::job::{Progress, Waker};
use super::loading::{Arrived, Destination, Loader, Loading, Source, Step};
use super::notes::Notes;
use super::state::{Clip, Edit, State, Transfer};
use crate::failure::Failure;
use crate::output::check_writable;
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
    /// None: by what suits the volume.
    view: Option<State>,
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
        match &source.file {
            Some(file) if is_view(file) && source.layout.is_none() => session.open(file)?,
            _ => session.load(source, None)?,
        }
        Ok(session)
    }

    /// Begins with some edits of what is shown, a saved view that is on its way included.
    pub(crate) fn edited(mut self, edits: &[Edit]) -> Result<Self, Failure> {
        let on_its_way = self.pending.as_mut().and_then(|pending| pending.view.as_mut());
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
        let Pending { source, loading, view } = self.pending.take()?;
        let step = self.loader.step(loading, gpu, time).and_then(|step| match step {
            Step::UnderWay(loading) => {
                self.pending = Some(Pending { source, loading, view });
                Ok(None)
            }
            Step::Done(arrived) => {
                let showing = self.showing(source, view, &arrived.facts)?;
                Ok(Some((arrived, showing)))
            }
        });
        step.unwrap_or_else(|failure| {
            self.refuse(&failure);
            None
        })
    }

    /// A volume that has arrived is shown from now on.
    pub(crate) fn show(&mut self, showing: Showing) {
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
        if is_at_rest
            && self.captures.is_empty()
            && let Some(turntable) = &mut self.turntable
        {
            match turntable.next_shot() {
                Some((capture, turn_deg)) => {
                    self.captures.push(capture);
                    let taken = std::mem::take(&mut self.captures);
                    self.perform(&Edit::Orbit { right_deg: turn_deg, up_deg: 0.0 }.into());
                    return taken;
                }
                None => self.turntable = None,
            }
        }
        let (now, later) = std::mem::take(&mut self.captures)
            .into_iter()
            .partition(|capture| is_at_rest || capture.subject == Subject::Window);
        self.captures = later;
        now
    }

    /// Does what it is told; what fails changes nothing.
    pub(crate) fn try_perform(&mut self, command: &Command) -> Result<(), Failure> {
        match command {
            Command::Edit(edit) => self.edit(edit),
            Command::Open(path) => self.open(path),
            Command::Drop(paths) => self.open_first(paths),
            Command::OpenShipped => self.load(Source { file: None, layout: None }, None),
            Command::Reload => self.load(self.source.clone(), Some(self.state.clone())),
            Command::Save(path) => self.save(path),
            Command::Picture(path) => {
                self.expect_volume()?;
                self.note_capture(Subject::Picture, path)
            }
            Command::Screenshot(path) => self.note_capture(Subject::Window, path),
            Command::Turntable { pictures, path } => {
                self.expect_volume()?;
                check_writable(path, "png")?;
                self.turntable = Some(Turntable::new(*pictures, path.clone()).map_err(Failure::input)?);
                Ok(())
            }
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

    fn open(&mut self, path: &Path) -> Result<(), Failure> {
        let path = absolute(path);
        if !is_view(&path) {
            return self.load(Source { file: Some(path), layout: None }, None);
        }
        let view = read_text_file(&path, MOST_VIEW_BYTES, "a saved view", State::from_json)?;
        let source = Source { file: view.file.clone(), layout: view.layout.clone() };
        if self.facts.is_some() && self.pending.is_none() && source == self.source {
            self.state = view;
            return Ok(());
        }
        self.load(source, Some(view))
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

    fn load(&mut self, source: Source, view: Option<State>) -> Result<(), Failure> {
        let loading = self.loader.begin(source.clone())?;
        self.pending = Some(Pending { source, loading, view });
        Ok(())
    }

    fn showing(&self, source: Source, view: Option<State>, facts: &Facts) -> Result<Showing, Failure> {
        let (state, preset) = match view {
            Some(view) => (view, None),
            None => {
                let suiting = suiting(&source);
                let clip = Clip { has_handles: self.state.clip.has_handles, ..Clip::default() };
                let mut state = self.state.clone();
                (state.file, state.layout) = (source.file.clone(), source.layout.clone());
                (state.transfer, state.clip) =
                    (facts.transfer(&transfer_spec::parse(suiting).map_err(Failure::input)?)?, clip);
                (state, Some(suiting.to_owned()))
            }
        };
        Ok(Showing { state, preset, facts: facts.clone(), source })
    }

    fn save(&mut self, path: &Path) -> Result<(), Failure> {
        check_writable(path, "json")?;
        let text = self.state.to_json().map_err(Failure::input)?;
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
        let session = session.edited(&[Edit::Refresh(17.0)]).unwrap();
        assert_eq!(session.state.pace.refresh_ms, 17.0);
        assert_eq!(session.pending.unwrap().view.unwrap().pace.refresh_ms, 17.0);
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
        let grid = Grid::centred([2, 2, 2], [1.0; 3]).unwrap();
        let volume = Volume::new(grid, Voxels::U8((0..8).collect())).unwrap();
        let facts = Facts::of(&volume, Some(Path::new("b.nrrd")));
        let arrives = |session: &Session| {
            let source = Source { file: Some("b.nrrd".into()), layout: None };
            session.showing(source, None, &facts).unwrap()
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
