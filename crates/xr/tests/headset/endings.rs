//! How sessions end.

use crate::inside::inside;
use crate::support::{begin, fill, make_frame, until, until_running};
use std::time::Duration;
use wheatstone_render::GpuError;
use wheatstone_xr::{EndReason, Graphics, Phase, Runtime, Session, SessionOptions, XrError};

const BLACK: [wgpu::Color; 2] = [wgpu::Color::BLACK; 2];

/// Makes frames until a call fails.
fn until_error(graphics: &Graphics, session: &mut Session) -> XrError {
    let frame = |session: &mut Session| -> Result<(), XrError> {
        session.poll()?;
        let mut frame = session.wait()?;
        let images = frame.acquire_eyes()?;
        fill(graphics.gpu(), &images, BLACK);
        frame.end(None)
    };
    (0..200).find_map(|_| frame(session).err()).expect("no call failed")
}

#[test]
fn a_runtime_that_is_killed_is_lost_without_a_panic() {
    inside(a_runtime_that_is_killed_is_lost_without_a_panic, |monado| {
        let (graphics, mut session) = begin(SessionOptions::default());
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        monado.kill();
        let error = until_error(&graphics, &mut session);
        assert!(matches!(error, XrError::RuntimeLost { .. }), "{error:?}");
        let again = session.wait().map(drop).unwrap_err();
        assert!(matches!(again, XrError::RuntimeLost { .. }), "{again:?}");
        assert!(matches!(session.poll(), Err(XrError::RuntimeLost { .. })));
        drop(session);
        graphics.gpu().check().unwrap();
        drop(graphics);
        let error = Runtime::connect("Wheatstone's tests").map(drop).unwrap_err();
        assert!(matches!(error, XrError::NoRuntime { .. }), "{error:?}");
    });
}

#[test]
fn a_runtime_that_is_killed_in_the_middle_of_a_frame_is_lost_without_a_panic() {
    inside(a_runtime_that_is_killed_in_the_middle_of_a_frame_is_lost_without_a_panic, |monado| {
        let (graphics, mut session) = begin(SessionOptions::default());
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        let mut frame = session.wait().unwrap();
        let images = frame.acquire_eyes().unwrap();
        fill(graphics.gpu(), &images, BLACK);
        monado.kill();
        let ended = frame.end(None);
        assert!(matches!(ended, Ok(()) | Err(XrError::RuntimeLost { .. })), "{ended:?}");
        let error = until_error(&graphics, &mut session);
        assert!(matches!(error, XrError::RuntimeLost { .. }), "{error:?}");
    });
}

#[test]
fn ten_sessions_come_and_go_in_one_program() {
    inside(ten_sessions_come_and_go_in_one_program, |_| {
        let mut open_files = Vec::new();
        for _ in 0..10 {
            let (graphics, mut session) = begin(SessionOptions::default());
            for _ in 0..3 {
                make_frame(&graphics, &mut session, BLACK);
            }
            session.request_exit().unwrap();
            let reason = loop {
                match session.poll().unwrap() {
                    Phase::Running => session.wait().unwrap().end(None).unwrap(),
                    Phase::Idle => std::thread::sleep(Duration::from_millis(5)),
                    Phase::Ended(reason) => break reason,
                }
            };
            assert_eq!(reason, EndReason::Exited);
            drop(session);
            drop(graphics);
            open_files.push(std::fs::read_dir("/proc/self/fd").unwrap().count());
        }
        assert!(open_files[9] <= open_files[1], "files that stay open: {open_files:?}");
    });
}

#[test]
fn a_session_may_be_dropped_while_it_runs_and_its_images_later() {
    inside(a_session_may_be_dropped_while_it_runs_and_its_images_later, |_| {
        let (graphics, mut session) = begin(SessionOptions::default());
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        let mut frame = session.wait().unwrap();
        let images = frame.acquire_eyes().unwrap();
        fill(graphics.gpu(), &images, BLACK);
        frame.end(None).unwrap();
        drop(session);
        drop(graphics);
        drop(images);
        let (graphics, mut session) = begin(SessionOptions::default());
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        drop(graphics);
        until_running(&mut session);
        session.wait().unwrap().end(None).unwrap();
    });
}

#[test]
fn frames_that_are_dropped_keep_no_images() {
    inside(frames_that_are_dropped_keep_no_images, |_| {
        let (graphics, mut session) = begin(SessionOptions::default());
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        for _ in 0..8 {
            until_running(&mut session);
            let mut frame = session.wait().unwrap();
            frame.acquire_eyes().unwrap();
            drop(frame);
            drop(session.wait().unwrap());
        }
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
    });
}

#[test]
fn a_lost_device_is_told_without_a_panic() {
    inside(a_lost_device_is_told_without_a_panic, |_| {
        let (graphics, mut session) =
            begin(SessionOptions { has_readable_images: true, ..Default::default() });
        until(&graphics, &mut session, "a picture", |_, tick| tick.eyes.is_some());
        graphics.gpu().device().destroy();
        let told = graphics.gpu().poll();
        assert!(matches!(told, Err(GpuError::Lost { .. })), "{told:?}");
        let mut frame = session.wait().unwrap();
        // Whether images can still be had is the driver's to say.
        let _ = frame.acquire_eyes();
        let _ = frame.end(None);
        assert!(matches!(graphics.gpu().check(), Err(GpuError::Lost { .. })));
    });
}
