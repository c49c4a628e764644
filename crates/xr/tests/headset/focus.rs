//! Who has the hands.

use crate::inside::inside;
use crate::remote::Controller;
use crate::support::{begin, make_frame, until};
use glam::{DQuat, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Side};
use wheatstone_xr::{SessionEvent, SessionOptions};

#[test]
fn a_second_program_takes_the_focus_and_gives_it_back() {
    inside(a_second_program_takes_the_focus_and_gives_it_back, |monado| {
        let (graphics, mut session) = begin(SessionOptions::default());
        if monado.is_second() {
            loop {
                make_frame(&graphics, &mut session, [wgpu::Color::WHITE; 2]);
            }
        }
        let held = Pose { position_m: DVec3::new(0.1, 1.0, -0.5), orientation: DQuat::IDENTITY };
        let held = Controller { squeeze: 1.0, ..Controller::at(held) };
        monado.remote().controller(Side::Left, &held).send();
        until(&graphics, &mut session, "the focus", |session, tick| {
            session.has_focus() && session.is_visible() && tick.hands[0].squeeze == 1.0
        });
        assert!(session.events().any(|event| event == SessionEvent::FocusGained));

        let mut second = monado.second();
        let lost = until(&graphics, &mut session, "the loss of the focus", |session, _| !session.has_focus());
        let without = make_frame(&graphics, &mut session, [wgpu::Color::BLACK; 2]);
        assert_eq!([lost.hands, without.hands], [[Hand::default(); 2]; 2]);
        assert!(session.events().any(|event| event == SessionEvent::FocusLost));

        second.kill().unwrap();
        second.wait().unwrap();
        until(&graphics, &mut session, "the focus again", |session, tick| {
            session.has_focus() && tick.eyes.is_some() && tick.hands[0].squeeze == 1.0
        });
        assert!(session.events().any(|event| event == SessionEvent::FocusGained));
    });
}
