//! Numbers of the messages that are used here.

/// What a frame is about; the numbers are the wire's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u16)]
pub enum Message {
    /// Signal strength of the network, percent.
    Wifi = 0x001a,
    /// Bit rate of the video.
    EncoderRate = 0x0020,
    /// Asks for parameter sets and video; to be repeated.
    VideoStart = 0x0025,
    /// 4:3 or 16:9.
    VideoMode = 0x0031,
    /// Exposure.
    Exposure = 0x0034,
    /// Whether it is too dark.
    Light = 0x0035,
    /// Asks for or gives the time of day.
    Time = 0x0046,
    /// Sticks; never acknowledged.
    Sticks = 0x0050,
    /// Take off.
    TakeOff = 0x0054,
    /// Land.
    Land = 0x0055,
    /// Flight data, about 10 Hz.
    FlightData = 0x0056,
    /// Flip.
    Flip = 0x005c,
    /// Take off when thrown.
    ThrowAndGo = 0x005d,
    /// Land on a palm.
    PalmLand = 0x005e,
    /// Header of the log; must be acknowledged or no data come.
    LogHeader = 0x1050,
    /// Log records.
    LogData = 0x1051,
    /// Configuration of the log.
    LogConfig = 0x1052,
}
