//! An interface of another control, as defined outside this crate: two kinds of block, its own names, no block of the SINUMERIK, and 32
//! axes. Names, addresses, presets, PLC programs, the mapped image and S7 must work with it.
#![cfg(all(feature = "mapped", feature = "s7"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::mem::offset_of;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use opennck::image::mapped::{Look, MappedImage, PlcImage, Rules, State, Step};
use opennck::image::{
    Area, AsBytes, Block, BlockTable, ByteRange, Interface, Layout, Memory, Names, Numbering, OverrideCoding, Part,
    Preset, Profile, SINUMERIK, Tables, ValueTerms, Window, Writer,
};
use opennck::plc::{NoNc, PlcIo, PlcProgram, enable_all, program_for};
use opennck::s7::Directory;
use opennck::signals;
use opennck::units::{AxisNumber, AxisSet, Time};

signals! {
    /// Bytes 0 and 1: signals from the PLC to the platform.
    pub struct PlatformToNck, platform_to_nck: Nck, Plc, 0 to 1;

    /// Release: 1 = drives can have power.
    bool, release, set_release: 0, 0;
    /// Number of the recipe.
    u8, recipe, set_recipe: 1, 7 to 0;
}

signals! {
    /// Bytes 2 to 5: signals from the platform to the PLC.
    pub struct PlatformFromNck, platform_from_nck: Nck, Nck, 2 to 5;

    numbers {
        /// Cycle counter.
        u32, cycles, set_cycles: 2;
    }
}

signals! {
    /// Byte 4: signals from the PLC to a drive.
    pub struct DriveToNck, drive_to_nck: Axis, Plc, 4 to 4;

    /// Power: 1 = on.
    bool, power, set_power: 4, 7;
}

signals! {
    /// Bytes 0 to 3: signals from a drive to the PLC.
    pub struct DriveFromNck, drive_from_nck: Axis, Nck, 0 to 3;

    numbers {
        /// Load in percent.
        f32, load, set_load: 0;
    }
}

#[derive(Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct ToNck {
    platform: PlatformToNck,
    drives: [DriveToNck; 32],
    plain: [u8; 2],
}

#[derive(Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
struct FromNck {
    platform: PlatformFromNck,
    drives: [DriveFromNck; 32],
}

static OWN: Interface = Interface::new(Tables {
    name: "own",
    blocks: &[
        BlockTable {
            block: Block::Nck,
            count: 1,
            names: &["platform"],
            called: "the platform",
            apart: None,
            ranges: &[
                ByteRange::signals(0, 1, Part::ToNck, 0, 0),
                ByteRange::signals(2, 5, Part::FromNck, 0, 0),
                ByteRange::plain(6, 7, offset_of!(ToNck, plain), 0),
            ],
        },
        BlockTable {
            block: Block::Axis,
            count: 32,
            names: &[],
            called: "drive",
            apart: None,
            ranges: &[
                ByteRange::signals(0, 3, Part::FromNck, offset_of!(FromNck, drives), 4),
                ByteRange::signals(4, 4, Part::ToNck, offset_of!(ToNck, drives), 1),
            ],
        },
    ],
    signals: &[PlatformToNck::SIGNALS, PlatformFromNck::SIGNALS, DriveToNck::SIGNALS, DriveFromNck::SIGNALS],
    to_nck: size_of::<ToNck>(),
    from_nck: size_of::<FromNck>(),
    hmi: 0,
    numberings: &[Numbering {
        name: "own",
        title: "the platform",
        number: 1,
        windows: &[Window::new(500, 0, 7, Block::Nck, 0, 1), Window::new(600, 0, 4, Block::Axis, 0, 32)],
        blocks: "DB500, DB600 to DB631",
        axes: "DB 599 + number of the drive",
    }],
    standard_blocks: &[],
    overrides: &[],
    switches: None,
    units: None,
    named_in: "the list of drives",
    example: "A1.power",
    values: ValueTerms::SINUMERIK,
});

/// The parts as the structures above.
#[derive(Debug)]
struct Own;

impl Layout for Own {
    type ToNck = ToNck;
    type FromNck = FromNck;
    type Hmi = [u8];

    fn is_of(interface: &Interface) -> bool {
        *interface == OWN
    }
}

/// No byte of this interface is an override.
fn coding() -> OverrideCoding {
    OverrideCoding::of(&OWN)
}

/// Names for all axes, from A1 on.
fn names() -> Names {
    let profile = Profile::named(&OWN, "own").unwrap();
    let mut names = Names { profile, ..Names::default() };
    for (number, name) in names.axes.iter_mut() {
        *name = Some(format!("A{number}"));
    }
    names
}

#[test]
fn every_signal_is_found_by_its_symbol_and_by_its_address() {
    let (memory, names) = (Memory::of(&OWN), names());
    names.check().unwrap();
    let mut found = 0;
    for signal in OWN.signals() {
        for number in 1..=OWN.count(signal.block) {
            let location = OWN.location(signal, number).unwrap();
            let symbol = names.symbol(location).unwrap();
            assert_eq!(names.resolve(&memory, &symbol), Ok(location), "{symbol}");
            let address = names.address(location).to_string();
            assert_eq!(names.resolve(&memory, &address), Ok(location), "{symbol} {address}");
            assert_eq!(names.writer(location), Some(signal.writer), "{symbol}");
            found += 1;
        }
    }
    assert_eq!(found, 3 + 2 * 32);
    let address = |symbol| names.address(names.resolve(&memory, symbol).unwrap()).to_string();
    assert_eq!(address("platform.recipe"), "DB500.DBB1");
    assert_eq!(address("A2.power"), "DB601.DBX4.7");
    assert_eq!(address("A1.load"), "DB600.DBD0");
    assert_eq!(drive_to_nck::power.writer, Writer::Plc);
}

#[test]
fn no_block_of_the_sinumerik_exists() {
    let (memory, names) = (Memory::of(&OWN), names());
    let refused = |text: &str| names.resolve(&memory, text).unwrap_err().to_string();
    assert!(
        refused("DB31.DBX2.1").contains("expected DB500, DB600 to DB631 or a block of the PLC program (), found DB31")
    );
    assert!(refused("nck.nc_ready").contains("expected one of `platform`, `A1`"));
    assert!(refused("platform.power").contains("expected a signal of `platform` (the platform)"));
    assert!(refused("DB600.DBB5").contains("5 bytes of DB600"));
    assert!(memory.blocks.iter().next().is_none() && memory.part(Part::Hmi).is_empty());
    assert!(!memory.fits(&SINUMERIK) && Profile::named(&OWN, "840d_sl").is_none());
    let twice = Names { profile: names.profile, ..Names::default() };
    assert_eq!(twice.owners().collect::<Vec<_>>(), [("platform", Block::Nck, 1)]);
    assert_eq!(Profile::default().interface().tables().name, "sinumerik");
}

#[test]
fn a_preset_and_the_structures_use_the_same_bytes() {
    let text = "[interface]\n\"platform.recipe\" = 7\n\"A2.power\" = 1\n\"DB500.DBB6\" = 9\n";
    let preset = Preset::parse(text, "own.toml").unwrap();
    let mut memory = Memory::from_preset(&preset, &names(), coding()).unwrap();
    let to_nck = ToNck::mut_from_bytes(&mut memory.to_nck).unwrap();
    assert_eq!((to_nck.platform.recipe(), to_nck.plain), (7, [9, 0]));
    assert!(to_nck.drives[1].power() && !to_nck.drives[0].power());
    to_nck.drives[31].set_power(true);
    assert_eq!(memory.read(names().resolve(&memory, "A32.power").unwrap()), 1);
    for refused in ["\"A1.load\" = 1.5", "\"platform.recipe\" = \"100%\""] {
        let refused = Preset::parse(&format!("[interface]\n{refused}\n"), "own.toml").unwrap();
        assert!(
            Memory::from_preset(&refused, &names(), coding()).is_err(),
            "the NCK writes it, or it is not an override"
        );
    }
}

#[test]
fn the_plc_changes_are_reported_by_axis() {
    let last = AxisNumber::new(32).unwrap();
    let memory = Memory::of(&OWN);
    let mut now = memory.clone();
    let to_nck = ToNck::mut_from_bytes(&mut now.to_nck).unwrap();
    to_nck.plain = [1, 2];
    assert_eq!(OWN.plc_changes(&memory.to_nck, &now.to_nck), (AxisSet::NONE, false));
    ToNck::mut_from_bytes(&mut now.to_nck).unwrap().drives[31].set_power(true);
    assert_eq!(OWN.plc_changes(&memory.to_nck, &now.to_nck), (AxisSet::of(last), false));
    ToNck::mut_from_bytes(&mut now.to_nck).unwrap().platform.set_release(true);
    assert!(OWN.plc_changes(&memory.to_nck, &now.to_nck).1);
}

/// The memory as a program sees it in a scan.
fn io<'a>(memory: &'a mut Memory, names: &'a Names, nc: &'a mut NoNc) -> PlcIo<'a, AsBytes> {
    PlcIo {
        to_nck: &mut memory.to_nck,
        from_nck: &memory.from_nck,
        hmi: &memory.hmi,
        inputs: &memory.inputs,
        outputs: &mut memory.outputs,
        flags: &mut memory.flags,
        timers: &mut memory.timers,
        counters: &mut memory.counters,
        blocks: &mut memory.blocks,
        cycle: 1,
        time: Time::ZERO,
        cycle_time: Time::ZERO,
        names,
        nc,
    }
}

#[test]
fn a_closure_uses_its_own_structures_and_a_closure_for_another_control_stops_the_plc() {
    let (mut memory, names) = (Memory::of(&OWN), names());
    FromNck::mut_from_bytes(&mut memory.from_nck).unwrap().drives[31].set_load(60.5);
    let mut unload = program_for::<_, Own>("unload", (), |(), io| {
        for axis in io.axes() {
            io.to_nck.drives[axis.index()].set_power(io.from_nck.drives[axis.index()].load() < 50.0);
        }
        Ok(())
    });
    unload.scan(&mut io(&mut memory, &names, &mut NoNc)).unwrap();
    let bit = |symbol| memory.read(names.resolve(&memory, symbol).unwrap());
    assert_eq!((bit("A1.power"), bit("A31.power"), bit("A32.power")), (1, 1, 0));
    let mut count = program_for::<_, AsBytes>("count", (), |(), io| {
        io.to_nck[1] += 1;
        Ok(())
    });
    count.scan(&mut io(&mut memory, &names, &mut NoNc)).unwrap();
    assert_eq!(memory.to_nck[1], 1);
    let fault = enable_all().scan(&mut io(&mut memory, &names, &mut NoNc)).unwrap_err();
    assert_eq!(fault.reason, "`enable_all` is written for another interface than own, the interface of this machine");
}

#[test]
fn the_mapped_image_has_its_data_blocks_and_takes_the_writes_of_the_plc() {
    let (mut memory, names) = (Memory::of(&OWN), names());
    let file = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("own_interface");
    let _ = std::fs::remove_file(&file);
    let rules = Rules { lock_step: false, time_out: Time::ZERO };
    let mut nc = MappedImage::create(&file, &memory, &names, rules).unwrap();
    nc.state(State::Run);
    let mut plc = PlcImage::open(&file).unwrap();
    let (power, load) = (plc.offset(Area::DataBlock(631), 4).unwrap(), plc.offset(Area::DataBlock(631), 0).unwrap());
    assert_eq!((plc.offset(Area::DataBlock(632), 0), plc.offset(Area::DataBlock(31), 0)), (None, None));
    let named = plc.sections().iter().find(|section| section.area == Area::DataBlock(631));
    assert_eq!(named.map(|section| section.name.as_str()), Some("A32"));
    nc.start();
    nc.publish(&memory, Step { cycle: 1, time: Time::ZERO, since_last: Time::ZERO }, false);
    plc.next_step().unwrap();
    plc.image_mut()[power] = 0x80;
    plc.image_mut()[load] = 0xFF;
    plc.answer();
    assert!(matches!(nc.look(0), Look::Answer(_)));
    nc.take(&mut memory);
    assert!(ToNck::ref_from_bytes(&memory.to_nck).unwrap().drives[31].power());
    assert!(memory.from_nck.iter().all(|byte| *byte == 0), "the PLC must not write signals of the NCK");
    drop(nc);
    std::fs::remove_file(&file).unwrap();
}

#[test]
fn s7_lists_its_data_blocks() {
    let (memory, names) = (Memory::of(&OWN), names());
    let directory = Directory::of(&memory, names.profile);
    let blocks: Vec<_> = directory.blocks().iter().map(|block| (block.number, block.length)).collect();
    assert_eq!((blocks.len(), blocks[0], blocks[32]), (33, (500, 8), (631, 5)));
}

#[test]
fn the_control_clears_only_its_own_signals() {
    let mut memory = Memory::of(&OWN);
    memory.from_nck.fill(0xFF);
    OWN.clear_signals(&mut memory.from_nck);
    assert!(memory.from_nck.iter().all(|byte| *byte == 0));
    assert!(Own::is_of(&OWN) && !Own::is_of(&SINUMERIK));
}
