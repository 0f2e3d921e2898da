//! The iron: slides, bridges, cams, limit switches and encoders. It knows nothing of bits called "referenced".

mod definition;

pub use definition::{
    AxisPlant, Bridge, Cam, Db11Byte5Bit2, Drive, EncoderKind, EncoderPlant, Given, Input,
    LimitSwitch, PlantDefinition,
};
