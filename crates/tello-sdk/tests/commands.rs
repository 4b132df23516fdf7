//! The wire text of every command and its way back.

#![allow(clippy::unwrap_used, clippy::panic)]

use proptest::prelude::*;
use tello_sdk::command::{
    Color, FrameRate, Glyph, Led, Matrix, MatrixColor, PadDirection, Pixels, Rate, Resolution,
    Scroll,
};
use tello_sdk::*;

fn waypoint() -> impl Strategy<Value = Waypoint> {
    (-500..=500i64, -500..=500i64, -500..=500i64)
        .prop_filter_map("too near", |(x, y, z)| Waypoint::from_cm(x, y, z).ok())
}

fn arc() -> impl Strategy<Value = Arc> {
    (20..300i64, 20..300i64, -50..50i64).prop_filter_map("no arc", |(x, y, z)| {
        Arc::from_cm([x, y, z], [2 * x, 0, 0]).ok()
    })
}

fn pad() -> impl Strategy<Value = Pad> {
    prop_oneof![
        (1..=8i64).prop_map(|n| Pad::Number(PadNumber::from_number(n).unwrap())),
        Just(Pad::FirstSeen),
        Just(Pad::Nearest),
    ]
}

fn distance() -> impl Strategy<Value = Distance> {
    (20..=500i64).prop_map(|cm| Distance::from_cm(cm).unwrap())
}

fn turn() -> impl Strategy<Value = Turn> {
    (1..=360i64).prop_map(|degrees| Turn::from_degrees(degrees).unwrap())
}

fn speed() -> impl Strategy<Value = Speed> {
    (10..=100i64).prop_map(|s| Speed::from_cm_per_s(s).unwrap())
}

fn arc_speed() -> impl Strategy<Value = ArcSpeed> {
    (10..=60i64).prop_map(|s| ArcSpeed::from_cm_per_s(s).unwrap())
}

fn stick() -> impl Strategy<Value = Stick> {
    (-100..=100i64).prop_map(|s| Stick::from_percent(s).unwrap())
}

fn color() -> impl Strategy<Value = Color> {
    any::<(u8, u8, u8)>().prop_map(|(red, green, blue)| Color { red, green, blue })
}

fn flight() -> impl Strategy<Value = Command> {
    prop_oneof![
        distance().prop_map(Command::Up),
        distance().prop_map(Command::Down),
        distance().prop_map(Command::Left),
        distance().prop_map(Command::Right),
        distance().prop_map(Command::Forward),
        distance().prop_map(Command::Back),
        turn().prop_map(Command::Clockwise),
        turn().prop_map(Command::CounterClockwise),
        (waypoint(), speed()).prop_map(|(to, speed)| Command::Go { to, speed }),
        (waypoint(), speed(), pad()).prop_map(|(to, speed, pad)| Command::GoPad { to, speed, pad }),
        (arc(), arc_speed()).prop_map(|(arc, speed)| Command::Curve { arc, speed }),
        (arc(), arc_speed(), pad()).prop_map(|(arc, speed, pad)| Command::CurvePad {
            arc,
            speed,
            pad
        }),
        (waypoint(), speed(), -360..=360i16, pad(), pad())
            .prop_map(|(to, speed, yaw, a, b)| Command::jump(to, speed, yaw, a, b).unwrap()),
        (stick(), stick(), stick(), stick()).prop_map(|(roll, pitch, throttle, yaw)| Command::Rc {
            roll,
            pitch,
            throttle,
            yaw
        }),
        speed().prop_map(Command::SetSpeed),
    ]
}

fn settings() -> impl Strategy<Value = Command> {
    prop_oneof![
        (1025..=65_535i64, 1025..=65_535i64).prop_map(|(state, video)| Command::Ports {
            state: Port::from_number(state).unwrap(),
            video: Port::from_number(video).unwrap()
        }),
        (0..=5i64).prop_map(|rate| Command::SetBitRate(BitRate::from_mbit_per_s(rate).ok())),
        ("[!-~]{1,32}", "[!-~]{8,63}")
            .prop_map(|(name, key)| Command::SetWifi(Credentials::new(&name, &key).unwrap())),
        ("[!-~]{1,32}", "[!-~]{8,63}").prop_map(|(name, key)| Command::JoinAccessPoint(
            Credentials::new(&name, &key).unwrap()
        )),
        color().prop_map(|c| Command::ExtLed(Led::Solid(c))),
        (1..=25u8, color())
            .prop_map(|(r, c)| Command::ExtLed(Led::Breathe(Rate::from_tenths_hz(r).unwrap(), c))),
        (1..=100u8, color(), color()).prop_map(|(r, a, b)| {
            Command::ExtLed(Led::Blink(Rate::from_tenths_hz(r).unwrap(), a, b))
        }),
        "[rbp0]{1,64}".prop_map(|p| Command::ExtMatrix(Matrix::Show(Pixels::new(&p).unwrap()))),
        "[rbp0]{1,64}".prop_map(|p| Command::ExtMatrix(Matrix::SetStart(Pixels::new(&p).unwrap()))),
        any::<u8>().prop_map(|level| Command::ExtMatrix(Matrix::Brightness(level))),
        "[!-~]".prop_map(|c| {
            let glyph = Glyph::Character(c.chars().next().unwrap());
            Command::ExtMatrix(Matrix::Glyph(MatrixColor::Blue, glyph))
        }),
        ("[!-~][ -~]{0,60}[!-~]", 1..=25u8).prop_map(|(text, rate)| {
            let rate = Rate::from_tenths_hz(rate).unwrap();
            let scroll = Scroll::new(MatrixColor::Purple, rate, &text).unwrap();
            Command::ExtMatrix(Matrix::Scroll(scroll.upwards()))
        }),
    ]
}

fn plain() -> Vec<Command> {
    let mut all = vec![
        Command::EnterSdk,
        Command::TakeOff,
        Command::Land,
        Command::Emergency,
        Command::Stop,
        Command::ThrowFly,
        Command::MotorOn,
        Command::MotorOff,
        Command::StreamOn,
        Command::StreamOff,
        Command::DownVision(true),
        Command::DownVision(false),
        Command::PadsOn,
        Command::PadsOff,
        Command::PadDirection(PadDirection::Both),
        Command::SetFrameRate(FrameRate::Middle),
        Command::SetResolution(Resolution::Low),
        Command::Reboot,
        Command::ExtMatrix(Matrix::ClearStart),
        Command::ExtMatrix(Matrix::Glyph(MatrixColor::Red, Glyph::Heart)),
        Command::RC_ZERO,
    ];
    all.extend([Flip::Left, Flip::Right, Flip::Forward, Flip::Back].map(Command::Flip));
    all.extend(Query::ALL.map(Command::Query));
    all
}

#[test]
fn commands_without_numbers_come_back() {
    for command in plain() {
        let text = command.to_string();
        assert!(!text.is_empty(), "{command:?}");
        assert_eq!(Command::parse(&text), Ok(command), "{text}");
    }
}

#[test]
fn the_wire_text_is_the_manuals() {
    let go = Command::Go {
        to: Waypoint::from_cm(100, -50, 20).unwrap(),
        speed: Speed::from_cm_per_s(30).unwrap(),
    };
    assert_eq!(go.to_string(), "go 100 -50 20 30");
    let curve = Command::Curve {
        arc: Arc::from_cm([100, 100, 0], [200, 0, 0]).unwrap(),
        speed: ArcSpeed::from_cm_per_s(20).unwrap(),
    };
    assert_eq!(curve.to_string(), "curve 100 100 0 200 0 0 20");
    let jump = Command::jump(
        Waypoint::from_cm(0, 0, 80).unwrap(),
        Speed::from_cm_per_s(40).unwrap(),
        90,
        Pad::Number(PadNumber::from_number(1).unwrap()),
        Pad::Nearest,
    );
    assert_eq!(jump.unwrap().to_string(), "jump 0 0 80 40 90 m1 m-2");
    assert_eq!(
        Command::parse("EXT led br 0.5 1 2 3").unwrap().to_string(),
        "EXT led br 0.5 1 2 3"
    );
}

#[test]
fn out_of_range_is_an_error_with_the_numbers_and_never_clamped() {
    for text in [
        "forward 19",
        "up 501",
        "cw 361",
        "rc 0 0 0 101",
        "speed 9",
        "port 80 9000",
    ] {
        assert!(
            matches!(
                Command::parse(text),
                Err(command::ParseCommandError::Range(_))
            ),
            "{text}"
        );
    }
    assert!(matches!(
        Command::parse("go 19 19 -19 50"),
        Err(command::ParseCommandError::Waypoint(
            command::WaypointError::TooNear { .. }
        ))
    ));
    // Another library sends -20 here.
    let arc = Command::parse("curve -100 100 0 -200 0 0 20").unwrap();
    assert_eq!(arc.to_string(), "curve -100 100 0 -200 0 0 20");
}

#[test]
fn wrong_texts_say_which_argument() {
    use command::ParseCommandError as E;
    assert_eq!(Command::parse(""), Err(E::Unknown));
    assert_eq!(Command::parse("Takeoff"), Err(E::Unknown));
    assert_eq!(Command::parse("forward"), Err(E::Argument { index: 1 }));
    assert_eq!(Command::parse("forward x"), Err(E::Argument { index: 1 }));
    assert_eq!(
        Command::parse("forward 50 60"),
        Err(E::Argument { index: 2 })
    );
    assert_eq!(
        Command::parse("go 100 0 0 50 m9x"),
        Err(E::Argument { index: 5 })
    );
    assert_eq!(Command::parse(" land\r\n"), Ok(Command::Land));
}

#[test]
fn no_command_that_starts_movement_may_be_repeated() {
    for text in [
        "takeoff",
        "forward 50",
        "flip l",
        "throwfly",
        "cw 90",
        "go 50 0 0 20",
        "motoron",
    ] {
        assert_eq!(
            Command::parse(text).unwrap().class(),
            Class::Motion,
            "{text}"
        );
    }
    assert_eq!(Command::Land.class(), Class::Safety);
    assert_eq!(Command::Query(Query::Battery).class(), Class::Query);
    assert_eq!(
        Command::parse("ap name password").unwrap().class(),
        Class::Once
    );
}

proptest! {
    #[test]
    fn flight_commands_come_back(command in flight()) {
        prop_assert_eq!(Command::parse(&command.to_string()), Ok(command));
    }

    #[test]
    fn settings_come_back(command in settings()) {
        prop_assert_eq!(Command::parse(&command.to_string()), Ok(command));
    }

    #[test]
    fn any_text_is_read_and_what_is_read_is_stable(text in "\\PC{0,60}") {
        if let Ok(command) = Command::parse(&text) {
            prop_assert_eq!(Command::parse(&command.to_string()), Ok(command));
        }
    }

    #[test]
    fn near_commands_are_read(text in "(go|curve|jump|rc|EXT led|EXT mled|port|ap|cw|flip)( [-0-9rbplmdg.]{1,6}){0,9}") {
        if let Ok(command) = Command::parse(&text) {
            prop_assert_eq!(Command::parse(&command.to_string()), Ok(command));
        }
    }
}
