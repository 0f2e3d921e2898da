//! Tests of machine data: tables, targets, classes of effect, both kinds of archives, and the check.

use proptest::prelude::*;

use crate::control::{Class, Finding};
use crate::sinumerik::parameters::cycle_time;
use crate::source::Place;
use crate::units::Time;

use super::*;

fn archive(text: &str) -> Archive {
    Archive::read([("a.tea", text.as_bytes())]).unwrap()
}

/// The findings of a rejected archive, each in one line.
fn refused(text: &str) -> Vec<String> {
    let findings = Archive::read([("a.tea", text.as_bytes())]).unwrap_err();
    findings.iter().map(|finding| finding.to_string().replace('\n', " ")).collect()
}

fn axis(number: u8) -> AxisNumber {
    AxisNumber::new(number).unwrap()
}

fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
}

/// Sets a value by text, like a scenario.
fn set(data: &mut MachineData, target: &str, value: &Value) {
    let target = data.parse_target(target).unwrap();
    data.set(&target, value).unwrap();
}

mod values {
    use super::*;

    #[test]
    fn a_field_is_named_as_its_identifier() {
        let data = serde_json::to_value(MachineData::default()).unwrap();
        for datum in catalogue() {
            let table = match datum.scope {
                Scope::General => &data["general"],
                Scope::Setting => &data["setting"],
                Scope::Channel => &data["channels"][0],
                Scope::ChannelSetting => &data["channel_settings"][0],
                Scope::Axis => &data["axes"][0],
                Scope::AxisSetting => &data["axis_settings"][0],
            };
            assert!(!table[datum.identifier.to_ascii_lowercase()].is_null(), "{datum}");
        }
    }

    #[test]
    fn every_value_of_every_datum_can_be_read_and_written_back() {
        let mut data = MachineData::default();
        for datum in catalogue() {
            let owner = match datum.scope {
                Scope::General | Scope::Setting => Owner::Nck,
                Scope::Channel | Scope::ChannelSetting => Owner::Channel(ChannelNumber::FIRST),
                Scope::Axis | Scope::AxisSetting => Owner::Axis(axis(31)),
            };
            for index in datum.indices() {
                let target = Target::new(datum.number, owner, index).unwrap();
                let value = data.get(&target).unwrap();
                data.store(&target, &value).unwrap();
            }
            if let Ok(beyond) = u8::try_from(datum.count) {
                assert!(Target::new(datum.number, owner, beyond).is_err(), "{datum}");
            }
        }
        assert_eq!(data, MachineData::default());
    }

    #[test]
    fn thirty_one_axis_names_are_unique() {
        let data = MachineData::default();
        for number in MachineData::axis_numbers() {
            assert_eq!(data.axis(data.axis_name(number)), Some(number));
            assert_eq!(data.axis(&format!("AX{number}")), Some(number));
        }
        assert_eq!((data.axis_name(axis(9)), data.axis_name(axis(10))), ("W1", "X2"));
    }

    #[test]
    fn machine_data_survive_saving() {
        let mut data = MachineData::default();
        set(&mut data, "34090[X1]", &Value::Real(-0.941));
        let bytes = postcard::to_stdvec(&data).unwrap();
        assert_eq!(postcard::from_bytes::<MachineData>(&bytes).unwrap(), data);
    }

    #[test]
    fn an_axis_that_becomes_rotary_takes_rotary_velocities_where_the_default_still_stood() {
        let mut data = MachineData::default();
        set(&mut data, "32020[X1]", &Value::Integer(7));
        set(&mut data, "30300[X1]", &Value::Boolean(true));
        let x = &data.axes[axis(1)];
        assert_eq!((x.max_ax_velo, x.jog_velo, x.refp_velo_search_marker), (27.77, 7.0, [0.833; 2]));
        set(&mut data, "30300[X1]", &Value::Boolean(false));
        assert_eq!((data.axes[axis(1)].max_ax_velo, data.axes[axis(1)].jog_velo), (10_000.0, 7.0));
    }

    #[test]
    fn the_interpolation_cycle_is_md10050_times_md10070() {
        assert_eq!(cycle_time(&MachineData::default()), Time::from_millis(12));
    }
}

mod targets {
    use super::*;

    #[test]
    fn every_way_of_writing_means_the_same_value() {
        let data = archive("N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"XF\"").data;
        for text in ["34090[XF]", "34090[0,AX3]", "$MA_REFP_MOVE_DIST_CORR[0,AX3]", "REFP_MOVE_DIST_CORR[ 0 , XF ]"] {
            let target = data.parse_target(text).unwrap();
            assert_eq!(target.to_string(), "$MA_REFP_MOVE_DIST_CORR[0,AX3]", "{text}");
        }
        assert_eq!(data.parse_target("34100[2,XF]").unwrap().index(), 2);
        assert_eq!(data.parse_target("11300").unwrap().owner(), Owner::Nck);
        assert_eq!(data.parse_target("20700").unwrap(), data.parse_target("20700[CHAN1]").unwrap());
        assert_eq!(data.parse_target("41110").unwrap().to_string(), "$SN_JOG_SET_VELO");
        assert_eq!(data.parse_target("SD41110"), data.parse_target("41110"));
        assert_eq!(data.parse_target("MD34100[2,XF]"), data.parse_target("34100[2,XF]"));
    }

    #[test]
    fn a_wrong_target_is_refused_with_the_nearest_name() {
        let data = MachineData::default();
        let cases = [
            ("99999", "99999"),
            ("REFP_SET_POSS[X1]", "`REFP_SET_POS`"),
            ("34100[4,X1]", "0 to 3"),
            ("34100[x1]", "`X1`"),
            ("34090", "machine axis"),
            ("11300[1]", "found `1`"),
            ("11300[X1]", "found `X1`"),
            ("20700[CHAN11]", "CHAN1 to CHAN10"),
            ("34090[0,X1,2]", "34090[XF]"),
            ("34090[X1", "34090[XF]"),
            ("", "34090[XF]"),
        ];
        for (text, part) in cases {
            let problem = data.parse_target(text).unwrap_err().to_string();
            assert!(problem.starts_with("expected ") && problem.contains(part), "{text}: {problem}");
        }
    }

    #[test]
    fn a_value_of_the_wrong_type_or_range_changes_nothing() {
        let mut data = MachineData::default();
        let cases = [
            ("37100[X1]", Value::Integer(256)),
            ("37100[X1]", Value::Real(1.5)),
            ("34000[X1]", Value::Integer(2)),
            ("34020[X1]", Value::Integer(-1)),
            ("34090[X1]", Value::Real(f64::INFINITY)),
            ("34090[X1]", Value::Real(f64::NAN)),
            ("34090[X1]", Value::Real(1e300)),
            ("34300[X1]", Value::Real(-1e-9)),
            ("10050", Value::Real(1e-12)),
            ("34090[X1]", Value::Text("1".to_owned())),
            ("20000", Value::Integer(1)),
            ("34093[X1]", Value::Real(1.0)),
        ];
        for (target, value) in cases {
            let target = data.parse_target(target).unwrap();
            assert!(data.set(&target, &value).is_err(), "{target} {value:?}");
        }
        assert_eq!(data, MachineData::default());
    }

    proptest! {
        #[test]
        fn any_text_is_a_target_or_a_problem(text: String) {
            let _ = MachineData::default().parse_target(&text);
        }
    }
}

mod effects {
    use super::*;

    /// One datum of each class for axis X1, changed in the stored set.
    fn changed() -> MachineData {
        let mut stored = MachineData::default();
        set(&mut stored, "34210[X1]", &Value::Integer(2));
        set(&mut stored, "32000[X1]", &Value::Integer(1));
        set(&mut stored, "34080[X1]", &Value::Integer(3));
        set(&mut stored, "34090[X1]", &Value::Integer(4));
        set(&mut stored, "11300", &Value::Integer(0));
        stored
    }

    fn after(level: Effect) -> (u8, f64, f64, f64, bool) {
        let mut active = MachineData::default();
        active.activate(&changed(), level);
        let x = &active.axes[axis(1)];
        let general = &active.general;
        (
            x.enc_refp_state[0],
            x.max_ax_velo,
            x.refp_move_dist[0],
            x.refp_move_dist_corr[0],
            general.jog_inc_mode_leveltriggrd,
        )
    }

    /// REF-22
    #[test]
    fn each_class_becomes_active_at_its_level_and_above() {
        assert_eq!(after(Effect::Immediate), (2, 10_000.0, -2.0, 0.0, true));
        assert_eq!(after(Effect::NewConf), (2, 1.0, -2.0, 0.0, true));
        assert_eq!(after(Effect::Reset), (2, 1.0, 3.0, 0.0, true));
        assert_eq!(after(Effect::PowerOn), (2, 1.0, 3.0, 4.0, false));
    }

    #[test]
    fn power_on_makes_everything_active() {
        let mut active = MachineData::default();
        active.activate(&changed(), Effect::PowerOn);
        assert_eq!(active, changed());
    }

    /// DEF-09
    #[test]
    fn definition_and_trip_limits_wait_for_power_on() {
        for number in [37100, 37120, 37130] {
            assert_eq!(by_number(number).unwrap().effect, Effect::PowerOn);
        }
        assert_eq!(by_number(37110).unwrap().effect, Effect::Reset);
        assert_eq!(by_number(37140).unwrap().effect, Effect::NewConf);
    }
}

mod ascii_archives {
    use super::*;

    #[test]
    fn import_is_as_tolerant_as_the_controls() {
        let text = b"\xEF\xBB\xBF%_N_INITIAL_INI\r\n;$PATH=/_N_DEF_DIR\r\nMETRIC\r\n\r\nCHANDATA( 2 )\r\n\
            n34100 $MA_REFP_SET_POS [ 1 , AX2 ] = 1EX-05 ; comment = 2\r\n\
            $MA_GANTRY_AXIS_TYPE[AX2]=11;'\r\n\
            N37150 $ma_gantry_function_mask[AX2]='B101' 'a3f\r\n\
            N10 $MC_REFP_NC_START_LOCK=0\r\n\
            $MC_CHAN_NAME=\"A;B\"\r\n\
            N34000 $MA_REFP_CAM_IS_ACTIVE[AX2]=FALSE\r\nM17 ; end\r\n\
            %_N_COMPLETE_TEA_INI\r\n$MC_REFP_NC_START_LOCK=2\r\nM30\r\n";
        let archive = Archive::read([("x.tea", text.as_slice())]).unwrap();
        let two = &archive.data.axes[axis(2)];
        assert_eq!((two.refp_set_pos[1], two.gantry_axis_type, two.gantry_function_mask), (1e-5, 11, 5));
        assert!(!two.refp_cam_is_active);
        let channel = |number| &archive.data.channels[ChannelNumber::new(number).unwrap()];
        assert_eq!((channel(2).refp_nc_start_lock, channel(1).refp_nc_start_lock), (0, 2));
        assert_eq!(channel(2).chan_name, "A;B");
        assert_eq!(archive.findings, []);
    }

    #[test]
    fn latin_1_is_read() {
        let archive = Archive::read([("x.ini", b"$MC_CHAN_NAME=\"Br\xFCcke\"\n".as_slice())]).unwrap();
        assert_eq!(archive.data.channels[ChannelNumber::FIRST].chan_name, "Brücke");
    }

    #[test]
    fn an_axis_may_be_named_before_its_name_is_given() {
        let archive = archive("$MA_GANTRY_AXIS_TYPE[XF]=11\nN10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"XF\"\n");
        assert_eq!(archive.data.axes[axis(3)].gantry_axis_type, 11);
        assert!(archive.given_axis(axis(3)) && !archive.given_axis(axis(1)));
        assert!(archive.is_given_for(37100, Owner::Axis(axis(3))));
        assert!(!archive.is_given(&archive.data.parse_target("37110[XF]").unwrap()));
    }

    #[test]
    fn an_arc_that_is_neither_text_nor_an_archive_is_damage_and_prints_no_control_characters() {
        let damaged = Archive::read([("m.arc", &[0xC3, 0x00, 0x1B, b'x'][..])]).unwrap_err();
        assert!(damaged[0].to_string().contains("at offset 0"), "{}", damaged[0]);
        let text = Archive::read([("m.tea", &b"\x1B[31m red"[..])]).unwrap_err();
        assert!(!text[0].to_string().contains('\x1B'), "{}", text[0]);
        assert!(Archive::read([("m.arc", &b"N37100 $MA_GANTRY_AXIS_TYPE[AX1]=1\n"[..])]).is_ok());
    }

    #[test]
    fn a_name_that_was_given_is_not_taken_by_the_default_of_another_axis() {
        // By default machine axis 2 is Y1 and machine axis 11 is Y2.
        let archive = archive("N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"Y1\"\nN37100 $MA_GANTRY_AXIS_TYPE[Y1]=1\n");
        assert_eq!(archive.data.axis_name(axis(2)), "AX2");
        assert_eq!(archive.data.axis("Y1"), Some(axis(1)));
        assert_eq!(archive.data.axes[axis(1)].gantry_axis_type, 1);
    }

    #[test]
    fn the_language_knows_no_case_but_names_do() {
        let archive = archive(
            "$mn_axconf_machax_name_tab[0]=\"Xa\"\n$ma_gantry_axis_type[ax1]=1\n$ma_gantry_axis_type[Ax31]=11\n",
        );
        assert_eq!(archive.data.axes[axis(1)].gantry_axis_type, 1);
        assert_eq!(archive.data.axes[axis(31)].gantry_axis_type, 11);
        assert_eq!((archive.data.axis("Xa"), archive.data.axis("XA")), (Some(axis(1)), None));
        assert_eq!(archive.data.channel("chan2"), archive.data.channel("CHAN2"));
    }

    #[test]
    fn a_later_assignment_replaces_an_earlier_one() {
        let files = [("a.tea", b"$MA_REFP_VELO_POS[AX1]=1\n".as_slice()), ("b.tea", b"$MA_REFP_VELO_POS[AX1]=2\n")];
        let archive = Archive::read(files).unwrap();
        let summary = &archive.summary;
        assert_eq!((archive.data.axes[axis(1)].refp_velo_pos, summary.taken, summary.members.len()), (2.0, 1, 2));
    }

    /// O-30
    #[test]
    fn a_value_out_of_range_in_a_text_file_is_kept_and_one_of_another_type_is_an_error() {
        let archive = archive("$MA_REFP_VELO_POS[AX1]=-1\n$MA_REFP_VELO_POS[AX2]=0\n$MA_REFP_VELO_POS[AX2]=10\n");
        assert_eq!((archive.data.axes[axis(1)].refp_velo_pos, archive.data.axes[axis(2)].refp_velo_pos), (-1.0, 10.0));
        let classes: Vec<_> = archive.findings.iter().map(|finding| finding.class).collect();
        assert_eq!(
            classes,
            [Class::Implausible, Class::Overlaid],
            "only the last value counts: {:?}",
            archive.findings
        );
        assert!(archive.findings[0].cure.ends_with("0 acts"), "{}", archive.findings[0]);
        assert_eq!(refused("$MA_REFP_VELO_POS[AX1]=\"fast\"\n").len(), 1);
    }

    #[test]
    fn lengths_of_an_inch_machine_are_in_inches_and_defaults_keep_their_length() {
        let inch = archive("INCH\n$MA_REFP_SET_POS[0,AX1]=2\n$MA_IS_ROT_AX[AX2]=1\n$MN_SCALING_SYSTEM_IS_METRIC=0\n$MA_REFP_SET_POS[0,AX2]=2\n").data;
        let x = &inch.axes[axis(1)];
        assert_near(x.refp_set_pos[0], 2.0);
        assert_eq!((x.max_ax_velo, x.max_ax_accel[0]), (10_000.0 / 25.4, 1.0 / 0.0254));
        // A rotary axis has no lengths.
        assert_near(inch.axes[axis(2)].max_ax_velo, 27.77);
        let metric = inch.acting(&[]);
        assert_eq!((metric.axes[axis(1)].refp_set_pos[0], metric.axes[axis(2)].refp_set_pos[0]), (50.8, 2.0));
        assert!((metric.axes[axis(1)].max_ax_velo - 10_000.0).abs() < 1e-9);
        // A file in the other system is converted, and says so.
        let mixed = archive("METRIC\n$MN_SCALING_SYSTEM_IS_METRIC=0\n$MA_REFP_SET_POS[0,AX1]=25.4\n");
        assert_near(mixed.data.axes[axis(1)].refp_set_pos[0], 1.0);
        assert!(mixed.findings[0].to_string().contains("METRIC, but MD10240 = 0"), "{}", mixed.findings[0]);
        let mixed = archive("INCH\n$MA_REFP_SET_POS[0,AX1]=2\n");
        assert_near(mixed.data.axes[axis(1)].refp_set_pos[0], 50.8);
        assert!(archive("$MN_SCALING_SYSTEM_IS_METRIC=0\n").write().contains("\nINCH\n"));
    }

    #[test]
    fn a_text_file_is_laid_over_another_with_a_finding_per_changed_value() {
        let files = [
            ("a.arc", b"$MA_REFP_VELO_POS[AX1]=1\n$MA_REFP_SET_POS[1,AX1]=2\n$MC_FOREIGN=1\n".as_slice()),
            ("b.tea", b"N34070 $MA_REFP_VELO_POS[AX1]=1\n$MA_REFP_SET_POS[1,AX1]=3\n$MA_REFP_SET_POS[2,AX1]=4\n"),
            ("c.tea", b"$MA_REFP_SET_POS[1,X1]=5\n$MC_FOREIGN=2\n"),
        ];
        let archive = Archive::read(files).unwrap();
        let positions = archive.data.axes[axis(1)].refp_set_pos;
        assert_near(positions[1], 5.0);
        assert_near(positions[2], 4.0);
        let overlaid = archive.findings.iter().filter(|finding| finding.class == Class::Overlaid);
        let expected = [
            "b.tea:2: overlaid: MD34100 $MA_REFP_SET_POS[1,AX1] = 3, axis X1: replaces 2 of a.arc:2",
            "c.tea:1: overlaid: MD34100 $MA_REFP_SET_POS[1,AX1] = 5, axis X1: replaces 3 of b.tea:2",
            "c.tea:2: overlaid: $MC_FOREIGN = 2: replaces 1 of a.arc:3",
        ];
        assert_eq!(overlaid.map(ToString::to_string).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn what_a_rotary_axis_was_given_stays_and_the_rest_is_rotary() {
        let archive = archive("$MA_MAX_AX_VELO[AX1]=10000\n$MA_IS_ROT_AX[AX1]=1\n");
        let x = &archive.data.axes[axis(1)];
        assert_eq!((x.max_ax_velo, x.jog_velo, x.ax_velo_limit), (10_000.0, 5.55, [31.94; 6]));
    }

    #[test]
    fn unknown_data_are_kept_and_warned_of() {
        let text = "N36901 $MA_SAFE_FUNCTION_ENABLE[AX9X]=500\n$TC_DP1[1,1]=120\nN18000 $MN_A=1 \n$MN_A=2\n";
        let archive = Archive::read([("a.arc", text.as_bytes())]).unwrap();
        assert_eq!(archive.unknown.len(), 3);
        assert_eq!(archive.unknown[2].value, "2");
        let warning = archive.findings[0].to_string();
        assert!(warning.starts_with("a.arc:1: not modelled: MD36901 $MA_SAFE_FUNCTION_ENABLE: "), "{warning}");
        assert!(archive.summary.to_string().starts_with("0 machine data taken, 3 unknown kept"));
    }

    #[test]
    fn what_a_person_wrote_and_the_catalogue_does_not_know_is_perhaps_mistyped() {
        let text = "$MA_MAX_AX_VEL0[X1]=5000\nN39999 $MA_FOO[X1]=5\nMAX_AX_VELO[X1]=5\n$MC_MAX_AX_VELO[X1]=5\n$TC_DP1[1,1]=120\n\
            N10 $MA_MAX_AX_VELO[X1]=5000\n";
        let archive = archive(text);
        let found: Vec<_> = archive.findings.iter().map(|finding| finding.to_string().replace('\n', " ")).collect();
        let starts = [
            "a.tea:1: unknown: $MA_MAX_AX_VEL0[X1] = 5000: expected a known machine datum",
            "a.tea:2: unknown: MD39999 $MA_FOO[X1] = 5: ",
            "a.tea:3: unknown: MAX_AX_VELO[X1] = 5: ",
            "a.tea:4: unknown: $MC_MAX_AX_VELO[X1] = 5: ",
            "a.tea:5: not modelled: $TC_DP1: ",
        ];
        assert_eq!(found.len(), starts.len(), "{found:?}");
        assert!(found.iter().zip(starts).all(|(found, start)| found.starts_with(start)), "{found:?}");
        assert!(
            found[0].contains("did you mean `MAX_AX_VELO`?") && found[1].contains("machine-data list"),
            "{found:?}"
        );
        assert!(found[2..4].iter().all(|found| found.contains("did you mean `$MA_MAX_AX_VELO`?")), "{found:?}");
        assert_near(archive.data.axes[axis(1)].max_ax_velo, 5_000.0);
        // O-30: a control knows what it exports, also in a file beside its archive.
        let files = [("a.arc", b"$MA_FOO[AX1]=1\n".as_slice()), ("b.tea", b"$MA_FOO[AX2]=1\n$MA_FOOT[AX2]=1\n")];
        let classes: Vec<_> = Archive::read(files).unwrap().findings.iter().map(|finding| finding.class).collect();
        assert_eq!(classes, [Class::Mistyped, Class::NotModelled]);
        let rows: String = (0..100).map(|number| format!("$MA_FOREIGN_{number}[AX1]=1\n")).collect();
        let many = "N32000 $MA_MAX_AX_VELO[AX1]=5\n".repeat(1_000);
        let checked = "N32000 $MA_MAX_AX_VELO[AX1]=5 'a3f\n";
        for export in [rows.as_str(), many.as_str(), checked] {
            let archive = self::archive(&format!("{text}{export}"));
            assert!(
                archive.findings.iter().all(|finding| finding.class == Class::NotModelled),
                "{:?}",
                archive.findings
            );
        }
    }

    #[test]
    fn a_number_that_contradicts_the_name_or_has_none_is_an_error() {
        let found =
            refused("N3200 $MA_MAX_AX_VELO[X1]=5\nN32010 $MA_MAX_AX_VELO[X1]=5\nN32000=5\nn34100[1,X1]=5\nN4=1\n");
        let parts = [
            "a.tea:1: error: $MA_MAX_AX_VELO: expected N32000 before $MA_MAX_AX_VELO, found N3200",
            "a.tea:2: error: MD32010 $MA_MAX_AX_VELO: expected N32000 before",
            "a.tea:3: error: N32000: expected the name of a machine datum after N32000, found none   write number and name such as \
             `N32000 $MA_MAX_AX_VELO[AX1]=…`",
            "a.tea:4: error: n34100: expected the name of a machine datum after N34100",
            "a.tea:5: error: N4: expected the name",
        ];
        assert_eq!(found.len(), parts.len(), "{found:?}");
        for (found, part) in found.iter().zip(parts) {
            assert!(found.starts_with(part), "{found} is not {part}");
        }
        assert_eq!(archive("N320 $MA_MAX_AX_VELO[X1]=5\nN7 $MA_MAX_AX_VELO[Y1]=5\n").findings, []);
    }

    #[test]
    fn two_lines_of_one_text_file_for_one_value_are_found() {
        let text = "$MA_REFP_VELO_POS[AX1]=1\n$MA_REFP_VELO_POS[X1]=2\n$MA_REFP_VELO_POS[X1]=2\n$MN_A=1\n$MN_A=2\n";
        let overlaid = |file: &str| {
            let archive = Archive::read([(file, text.as_bytes())]).unwrap();
            let found = archive.findings.iter().filter(|finding| finding.class == Class::Overlaid);
            found.map(ToString::to_string).collect::<Vec<_>>()
        };
        let expected = [
            "a.tea:2: overlaid: MD34070 $MA_REFP_VELO_POS[AX1] = 2, axis X1: replaces 1 of a.tea:1",
            "a.tea:5: overlaid: $MN_A = 2: replaces 1 of a.tea:4",
        ];
        assert_eq!(overlaid("a.tea"), expected);
        assert_eq!(overlaid("a.arc"), [""; 0]);
    }

    #[test]
    fn every_mistake_names_file_line_number_and_identifier() {
        let text = "N37110 $MA_GANTRY_AXIS_TYPE[AX1]=1\n$MA_GANTRY_AXIS_TYPE[AX1]=x\nN34100 $MA_REFP_SET_POS[7,AX1]=0\n\
            N37100 $MA_GANTRY_AXIS_TYPE[XF]=1\nN37100 $MA_GANTRY_AXIS_TPYE[AX1]=1\n$MA_NUM_ENCS[AX1]=1.5\n";
        let findings = refused(text);
        assert_eq!(findings.len(), 6);
        assert!(
            findings[0].starts_with("a.tea:1: error: MD37110 $MA_GANTRY_AXIS_TYPE: expected N37100"),
            "{findings:?}"
        );
        assert!(findings[1].contains("found `x`") && findings[1].starts_with("a.tea:2: error: MD37100 "));
        assert!(findings[2].contains("0 to 3") && findings[2].starts_with("a.tea:3: "));
        assert!(findings[3].contains("found `XF`") && findings[3].starts_with("a.tea:4: "));
        assert!(findings[4].contains("did you mean `GANTRY_AXIS_TYPE`?"));
        assert!(findings[5].contains("a whole number from 0 to 255") && findings[5].contains("found 1.5"));
    }

    #[test]
    fn a_wrong_channel_and_a_line_that_is_none_are_refused() {
        assert!(refused("CHANDATA(11)\n")[0].contains("CHANDATA(1) to CHANDATA(10)"));
        assert!(refused("G0 X10\n")[0].contains("found `G0 X10`"));
        assert!(refused("$MA_REFP_VELO_POS[AX1]=\n")[0].starts_with("a.tea:1: "));
    }

    #[test]
    fn a_refusal_names_the_first_mistake_and_counts_the_others() {
        let findings = Archive::read([("a.tea", b"G1\nG0\n".as_slice())]).unwrap_err();
        let problem = refusal(&findings).to_string();
        assert!(problem.starts_with("a.tea:1: expected an assignment") && problem.contains("1 more"), "{problem}");
    }

    proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
            let _ = Archive::read([("a.tea", bytes.as_slice())]);
        }

        #[test]
        fn any_lines_that_look_right_are_read_or_refused(
            lines in prop::collection::vec("(N[0-9]{0,6} ?)?\\$M[ANC]_[A-Z_]{1,20}(\\[[0-9AX,]{0,6}\\])? ?=[ -~]{0,9}", 0..8)
        ) {
            let _ = Archive::read([("a.tea", lines.join("\n").as_bytes())]);
        }
    }
}

mod writing {
    use super::*;

    /// The content of a file, without places.
    fn said(archive: &Archive) -> (MachineData, Vec<Target>, Vec<(String, ChannelNumber, String)>) {
        let unknown = archive.unknown.iter().map(|one| (one.name.clone(), one.channel, one.value.clone()));
        (archive.data.clone(), archive.given.keys().copied().collect(), unknown.collect())
    }

    #[test]
    fn an_archive_is_written_as_the_control_exports_it() {
        let text = "N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"XF\"\nCHANDATA(2)\n$MC_REFP_NC_START_LOCK=TRUE0\n";
        assert_eq!(refused(text).len(), 1);
        let text = "$MN_AXCONF_MACHAX_NAME_TAB[2]=\"XF\"\n$MA_GANTRY_FUNCTION_MASK[XF]=28\n\
            $MA_REFP_MOVE_DIST_CORR[XF]=0.00001\n$MA_REFP_CAM_IS_ACTIVE[XF]=TRUE\nCHANDATA(2)\n\
            $MC_REFP_NC_START_LOCK=0\n$MC_FOREIGN[1]='H1'\n";
        let expected = "%_N_INITIAL_INI\n;$PATH=/\nMETRIC\n\nCHANDATA(1)\n\
            N10000 $MN_AXCONF_MACHAX_NAME_TAB[2]=\"XF\"\nN34000 $MA_REFP_CAM_IS_ACTIVE[AX3]=1\n\
            N34090 $MA_REFP_MOVE_DIST_CORR[0,AX3]=1EX-05\nN37150 $MA_GANTRY_FUNCTION_MASK[AX3]='H1c'\n\
            CHANDATA(2)\nN20700 $MC_REFP_NC_START_LOCK=0\n$MC_FOREIGN[1]='H1'\nM17\n";
        assert_eq!(archive(text).write(), expected);
    }

    #[test]
    fn what_was_written_is_read_as_the_same() {
        let text =
            "$MA_IS_ROT_AX[AX2]=1\n$MA_MAX_AX_VELO[AX2]=10000\n$MN_X=7\nCHANDATA(3)\n$MC_CHAN_NAME=\"Ä\"\n$MC_Y=1\n";
        let first = archive(text);
        assert_eq!(said(&archive(&first.write())), said(&first));
    }

    proptest! {
        #[test]
        fn any_values_survive_writing_and_reading(
            values in prop::collection::vec((0..10_000usize, 0..31u8, 0..31u8, -1e9..1e9f64, any::<bool>()), 1..40)
        ) {
            let mut first = archive("");
            let data: Vec<_> = catalogue().collect();
            for (row, owner, index, number, small) in values {
                let datum = data[row % data.len()];
                let owner = match datum.scope {
                    Scope::General | Scope::Setting => Owner::Nck,
                    Scope::Channel | Scope::ChannelSetting => {
                        Owner::Channel(ChannelNumber::new(owner % 10 + 1).unwrap())
                    }
                    Scope::Axis | Scope::AxisSetting => Owner::Axis(axis(owner + 1)),
                };
                let target = Target::new(datum.number, owner, u8::try_from(u16::from(index) % datum.count).unwrap()).unwrap();
                let number = if small { (number / 1e7).round() } else { number / 1e7 };
                // Names are not changed: an archive with duplicate axis names is a separate case.
                if datum.kind != crate::control::Kind::String && first.data.store(&target, &Value::Real(number)).is_ok() {
                    first.given.insert(target, Place::file("a.tea"));
                }
            }
            let text = first.write();
            let second = archive(&text);
            for target in first.given.keys() {
                prop_assert_eq!(second.data.get(target), first.data.get(target), "{} in\n{}", target, text);
            }
            prop_assert_eq!(said(&archive(&second.write())), said(&second));
        }
    }
}

mod binary_archives {
    use super::*;

    /// A member in the format of the table in the format description.
    fn member(internal: &str, shown: &str, folder: &str, data: &[u8]) -> Vec<u8> {
        let mut header = [0_u8; 512];
        let mut put = |at: usize, text: &str| header[at..at + text.len()].copy_from_slice(text.as_bytes());
        put(0, internal);
        put(50, shown);
        put(100, "77777");
        put(108, if internal.starts_with("@@") { "0" } else { "7" });
        put(116, "040703");
        put(124, &data.len().to_string());
        put(136, "1400000000");
        put(257, "/");
        put(384, folder);
        let sum: u64 = header.iter().map(|&byte| u64::from(byte)).sum();
        header[148..148 + sum.to_string().len()].copy_from_slice(sum.to_string().as_bytes());
        let mut bytes = header.to_vec();
        bytes.extend(data);
        bytes.resize(bytes.len().next_multiple_of(512), 0);
        bytes
    }

    fn small() -> Vec<u8> {
        let nc = r"\_NC_ACT.DIR\";
        let mut bytes = member("@@MMCIBN.002", "", "", b";---creation stamp---\n;---components---\nNCKComp\n");
        bytes.extend(member(
            "_N_CFG_GLOBAL_INI",
            "CFG_GLOBAL.INI",
            nc,
            b"N11300 $MN_JOG_INC_MODE_LEVELTRIGGRD=1\nM17\n",
        ));
        bytes.extend(member("_N_INITIAL_INI", "INITIAL.INI", nc, b"METRIC\n\nCHANDATA(1)\nN11300 $MN_JOG_INC_MODE_LEVELTRIGGRD=0\nN37100 $MA_GANTRY_AXIS_TYPE[AX3]=11\nN4 $X=2\nM17\n"));
        bytes.extend(member("@@_N_ADRV_SINAMICS_1", "", "", b""));
        bytes.extend(member("_N_PS000001_TEA", "PS000001.TEA", r"\ADRV.DIR\", b"p10=1\n"));
        bytes
    }

    fn read(bytes: &[u8]) -> Result<Archive, Vec<Finding>> {
        Archive::read([("m.arc", bytes)])
    }

    #[test]
    fn machine_data_are_taken_and_other_members_listed() {
        let archive = read(&small()).unwrap();
        assert!(!archive.data.general.jog_inc_mode_leveltriggrd);
        assert_eq!(archive.data.axes[axis(3)].gantry_axis_type, 11);
        assert_eq!((archive.summary.taken, archive.summary.unknown), (2, 1));
        let summary = archive.summary.to_string();
        assert!(summary.contains("m.arc(INITIAL.INI): 3 assignments"), "{summary}");
        assert!(summary.contains(", 1 member without machine data ignored\n"), "{summary}");
        assert_eq!(archive.summary.ignored().collect::<Vec<_>>(), [r"\ADRV.DIR\PS000001.TEA"]);
        assert!(archive.findings[0].to_string().starts_with("m.arc(INITIAL.INI):6: not modelled: "));
    }

    #[test]
    fn a_truncated_archive_is_named_with_its_offset() {
        let bytes = small();
        let cut = read(&bytes[..2_700]).unwrap_err();
        assert!(cut[0].what.contains("at offset 2560: the file ends too early, at 2700 bytes"), "{}", cut[0]);
        let cut = read(&bytes[..1_540]).unwrap_err();
        assert!(
            cut[0].what.contains("of _N_CFG_GLOBAL_INI and their padding, found 4 bytes at offset 1536"),
            "{}",
            cut[0]
        );
    }

    #[test]
    fn a_text_in_utf_16_is_named_with_the_way_to_convert_it() {
        let text = "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=1\r\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let marked = [&[0xFF, 0xFE][..], &little].concat();
        let marked_big = [&[0xFE, 0xFF][..], &big].concat();
        // Without a byte order mark, `iconv -f UTF-16` takes the order of the computer.
        for (name, bytes, order, iconv, power_shell) in [
            ("a.tea", &little, "little-endian", "UTF-16LE", "Unicode"),
            ("my data/b.tea", &big, "big-endian", "UTF-16BE", "BigEndianUnicode"),
            ("a.arc", &marked, "little-endian", "UTF-16", "Unicode"),
            ("a.tea", &marked_big, "big-endian", "UTF-16", "BigEndianUnicode"),
        ] {
            let refused = Archive::read([(name, &bytes[..])]).unwrap_err();
            let [finding] = &refused[..] else { panic!("one finding: {refused:?}") };
            assert!(finding.what.contains(&format!("found a text in UTF-16 ({order})")), "{finding}");
            for command in [
                format!("`iconv -f {iconv} -t UTF-8 '{name}' > NEW_FILE`"),
                format!("`Get-Content -Encoding {power_shell} '{name}' | Set-Content -Encoding utf8 NEW_FILE`"),
            ] {
                assert!(finding.cure.contains(&command), "{finding}");
            }
        }
        let quoted = Archive::read([("it's.tea", &little[..])]).unwrap_err();
        assert!(quoted[0].cure.contains(r"'it'\''s.tea' > "), "{}", quoted[0]);
    }

    #[test]
    fn a_file_without_machine_data_is_a_finding() {
        for (text, found) in [("", "found an empty file"), ("; nothing\nM17\n", "found no assignment")] {
            let archive = Archive::read([("a.tea", text.as_bytes())]).unwrap();
            let [finding] = &archive.findings[..] else { panic!("one finding: {:?}", archive.findings) };
            assert!(finding.what.contains(found) && finding.class == Class::Implausible, "{finding}");
        }
    }

    #[test]
    fn a_wrong_checksum_is_named_with_its_offset() {
        let mut bytes = small();
        bytes[1_030] ^= 1;
        let findings = read(&bytes).unwrap_err();
        assert!(
            findings[0].what.contains("checksum") && findings[0].what.ends_with("at offset 1024"),
            "{}",
            findings[0]
        );
    }

    #[test]
    fn a_large_archive_of_mostly_unknown_data_is_read() {
        let mut bytes = member("@@MMCIBN.002", "", "", b";---components---\n");
        for number in 0..298 {
            bytes.extend(member(
                &format!("_N_PS{number:06}_TEA"),
                &format!("PS{number}.TEA"),
                r"\A.DIR\",
                &[b'x'; 9_000],
            ));
        }
        let mut text = "METRIC\n\nCHANDATA(1)\n".to_owned();
        for number in 0..24_000 {
            text += &format!("N{} $MA_FOREIGN_{}[{},AX{}]=0.5\n", 40_000 + number / 100, number / 100, number % 100, 1);
        }
        for number in 0..1_000 {
            text += &format!("N34100 $MA_REFP_SET_POS[{},AX{}]={number}\n", number % 4, number % 31 + 1);
        }
        bytes.extend(member("_N_INITIAL_INI", "INITIAL.INI", r"\_NC_ACT.DIR\", text.as_bytes()));
        let archive = read(&bytes).unwrap();
        assert_eq!((archive.summary.members.len(), archive.summary.unknown, archive.summary.taken), (299, 24_000, 124));
        assert_eq!(archive.findings.len(), 240);
    }

    /// O-30
    #[test]
    fn a_value_that_a_control_exported_is_never_an_error() {
        let nc = r"\_NC_ACT.DIR\";
        let text = "METRIC\n\nCHANDATA(1)\nN34020 $MA_REFP_VELO_SEARCH_CAM[AX2]=0\nN34060 $MA_REFP_MAX_MARKER_DIST[0,AX2]=-3\n\
            N34100 $MA_REFP_SET_POS[7,AX2]=5\nN34200 $MA_ENC_REFP_MODE[0,AX2]=300\nN34099 $MA_REFP_SET_POS[0,AX2]=5\n\
            N37100 $MA_GANTRY_AXIS_TYPE[AX77]=1\nN10050 $MN_SYSCLOCK_CYCLE_TIME=0\nM17\n";
        let mut bytes = member("@@MMCIBN.002", "", "", b";---components---\n");
        bytes.extend(member("_N_INITIAL_INI", "INITIAL.INI", nc, text.as_bytes()));
        let archive = read(&bytes).unwrap();
        let two = &archive.data.axes[axis(2)];
        assert_eq!((two.refp_velo_search_cam, two.refp_max_marker_dist[0], two.enc_refp_mode[0]), (0.0, -3.0, 1));
        assert_near(archive.data.general.sysclock_cycle_time, 0.0);
        // What does not fit the catalogue at all is kept to be written back.
        let kept: Vec<_> = archive.unknown.iter().map(|unknown| unknown.name.as_str()).collect();
        let unfit = [
            "$MA_REFP_SET_POS[7,AX2]",
            "$MA_ENC_REFP_MODE[0,AX2]",
            "$MA_REFP_SET_POS[0,AX2]",
            "$MA_GANTRY_AXIS_TYPE[AX77]",
        ];
        assert_eq!(kept, unfit);
        assert_eq!(archive.summary.unknown, 4);
        let found: Vec<_> = archive.findings.iter().filter(|finding| finding.class == Class::Implausible).collect();
        assert_eq!(
            found.iter().map(|finding| finding.place.as_ref().unwrap().line).collect::<Vec<_>>(),
            [4, 5, 6, 7, 8, 9, 10]
        );
        let text = found[0].to_string();
        let expected = "m.arc(INITIAL.INI):4: implausible: MD34020 $MA_REFP_VELO_SEARCH_CAM[AX2] = 0, axis Y1: expected more than 0";
        assert!(text.starts_with(expected), "{text}");
        // The model works with permitted values.
        let out_of_range: Vec<_> = archive.out_of_range.iter().map(Target::to_string).collect();
        assert_eq!(out_of_range, ["$MN_SYSCLOCK_CYCLE_TIME", "$MA_REFP_MAX_MARKER_DIST[0,AX2]"]);
        let limited = archive.data.within_range(&archive.out_of_range);
        assert_near(limited.axes[axis(2)].refp_max_marker_dist[0], 0.0);
        assert_near(limited.general.sysclock_cycle_time, 0.000_01);
    }

    proptest! {
        #[test]
        fn any_bytes_behind_the_first_name_are_read_or_refused(bytes: Vec<u8>) {
            let _ = read(&[b"@@MMCIBN.002".as_slice(), &bytes].concat());
        }

        #[test]
        fn any_damage_is_read_or_refused(at in 0..3_000_usize, to: u8, keep in 0..5_000_usize) {
            let mut bytes = small();
            let last = bytes.len() - 1;
            bytes[at.min(last)] = to;
            bytes.truncate(keep);
            let _ = read(&bytes);
        }

        #[test]
        fn any_size_is_read_or_refused(size in "[0-9]{1,12}") {
            let mut bytes = member("@@MMCIBN.002", "", "", b"");
            bytes[124..136].fill(0);
            bytes[124..124 + size.len()].copy_from_slice(size.as_bytes());
            bytes[148..156].fill(0);
            let sum: u64 = bytes[..512].iter().map(|&byte| u64::from(byte)).sum();
            bytes[148..148 + sum.to_string().len()].copy_from_slice(sum.to_string().as_bytes());
            let _ = read(&bytes);
        }
    }
}

mod checking {
    use super::*;

    fn found(text: &str) -> Vec<String> {
        check(&archive(text)).iter().map(ToString::to_string).collect()
    }

    /// MON-16
    #[test]
    fn gantry_limits_out_of_order_are_found_also_without_a_warning_limit() {
        let text = "$MA_GANTRY_AXIS_TYPE[AX1]=1\n$MA_GANTRY_POS_TOL_WARNING[AX1]=2\n\
            $MA_GANTRY_POS_TOL_ERROR[AX1]=1\n$MA_GANTRY_POS_TOL_REF[AX1]=1\n";
        let findings = found(text);
        assert_eq!(findings.len(), 2, "{findings:?}");
        assert!(
            findings[0]
                .starts_with("a.tea:3: implausible: MD37120 $MA_GANTRY_POS_TOL_ERROR[AX1] = 1, axis X1: MON-16: "),
            "{findings:?}"
        );
        assert!(findings[1].starts_with("a.tea:4: implausible: MD37130 "));
        // Without the warning limit equal limits are in order, an MD37120 above MD37130 is not.
        let without = text.replace("WARNING[AX1]=2", "WARNING[AX1]=0");
        assert_eq!(found(&without), [""; 0]);
        let findings = found(&without.replace("ERROR[AX1]=1", "ERROR[AX1]=1.5"));
        assert_eq!(findings.len(), 1, "{findings:?}");
        assert!(findings[0].contains("MD37130") && findings[0].contains("MON-16: expected more than MD37120 = 1.5"));
        assert_eq!(found(&text.replace("TYPE[AX1]=1", "TYPE[AX1]=0")), [""; 0]);
    }

    #[test]
    fn limits_and_times_of_monitoring_out_of_order_are_found() {
        let text = "$MA_STOP_LIMIT_FINE[AX1]=0.05\n$MA_STANDSTILL_POS_TOL[AX2]=0.03\n$MA_MAX_AX_VELO[AX2]=12000\n\
            $MA_SERVO_DISABLE_DELAY_TIME[AX3]=0.04\n";
        let findings = found(text);
        let starts = [
            "implausible: MD36000 $MA_STOP_LIMIT_COARSE[AX1] = 0.04, axis X1: expected at least MD36010 = 0.05",
            "a.tea:2: implausible: MD36030 $MA_STANDSTILL_POS_TOL[AX2] = 0.03, axis Y1: expected at least MD36000 = 0.04",
            "implausible: MD36200 $MA_AX_VELO_LIMIT[0,AX2] = 11500, axis Y1: expected at least MD32000 = 12000",
            "a.tea:4: implausible: MD36620 $MA_SERVO_DISABLE_DELAY_TIME[AX3] = 0.04, axis Z1: expected at least MD36610 = 0.05",
        ];
        assert_eq!(findings.len(), starts.len(), "{findings:?}");
        for (finding, start) in findings.iter().zip(starts) {
            assert!(finding.contains(start), "{finding} is not {start}");
        }
        let equal = "$MA_STOP_LIMIT_FINE[AX1]=0.04\n$MA_SERVO_DISABLE_DELAY_TIME[AX3]=0.05\n";
        assert_eq!(found(equal), [""; 0]);
    }

    /// DYN-03
    #[test]
    fn data_that_must_be_equal_within_a_grouping_are_found_on_the_synchronous_axis() {
        let grouping = "$MA_GANTRY_AXIS_TYPE[AX1]=2\n$MA_GANTRY_AXIS_TYPE[AX3]=12\n";
        let text = format!(
            "{grouping}$MA_FIPO_TYPE[AX3]=1\n$MA_AX_JERK_ENABLE[AX3]=1\n$MA_AX_JERK_TIME[AX1]=0.004\n\
            $MA_JOG_AND_POS_JERK_ENABLE[AX3]=1\n$MA_JOG_AND_POS_MAX_JERK[AX3]=50\n"
        );
        let findings = found(&text);
        let starts = [
            "a.tea:3: implausible: MD33000 $MA_FIPO_TYPE[AX3] = 1, axis Z1: DYN-03: expected 2, as leading axis X1 has",
            "a.tea:4: implausible: MD32400 $MA_AX_JERK_ENABLE[AX3] = 1, axis Z1: DYN-03: expected 0",
            "implausible: MD32410 $MA_AX_JERK_TIME[AX3] = 0.001, axis Z1: DYN-03: expected 0.004, as leading axis X1 has",
            "a.tea:6: implausible: MD32420 $MA_JOG_AND_POS_JERK_ENABLE[AX3] = 1, axis Z1: DYN-03: ",
            "a.tea:7: implausible: MD32430 $MA_JOG_AND_POS_MAX_JERK[AX3] = 50, axis Z1: DYN-03: expected 100",
        ];
        assert_eq!(findings.len(), starts.len(), "{findings:?}");
        for (finding, start) in findings.iter().zip(starts) {
            assert!(finding.starts_with(start), "{finding}");
        }
        // Equal data, another grouping, or no grouping: no finding.
        let equal = "$MA_FIPO_TYPE[AX1]=1\n$MA_FIPO_TYPE[AX3]=1\n";
        assert_eq!(found(&format!("{grouping}{equal}")), [""; 0]);
        assert_eq!(found(&text.replace("=12", "=13")), [""; 0]);
        assert_eq!(found(&text.replace("=12", "=0")), [""; 0]);
    }

    /// REF-28
    #[test]
    fn an_encoder_switch_over_tolerance_not_below_the_warning_limit_is_found_with_two_encoders() {
        let text = "$MA_GANTRY_AXIS_TYPE[AX1]=1\n$MA_GANTRY_POS_TOL_WARNING[AX1]=0.1\n$MA_NUM_ENCS[AX1]=2\n\
            $MA_GANTRY_POS_TOL_ERROR[AX1]=1\n$MA_GANTRY_POS_TOL_REF[AX1]=2\n";
        let findings = found(text);
        assert!(
            findings.len() == 1 && findings[0].contains("MD36500 $MA_ENC_CHANGE_TOL[AX1] = 0.1, axis X1: REF-28"),
            "{findings:?}"
        );
        assert_eq!(found(&text.replace("NUM_ENCS[AX1]=2", "NUM_ENCS[AX1]=1")), [""; 0]);
    }

    #[test]
    fn cycles_and_names_are_found() {
        assert!(found("$MN_SYSCLOCK_CYCLE_TIME=0.4")[0].starts_with("a.tea:1: implausible: MD10050 "));
        let twice = "$MN_AXCONF_MACHAX_NAME_TAB[0]=\"Q\"\n$MN_AXCONF_MACHAX_NAME_TAB[1]=\"Q\"";
        assert!(found(twice)[0].contains("which axis 1 has"));
        assert!(found("$MN_AXCONF_MACHAX_NAME_TAB[0]=\"AX2\"")[0].contains("means axis 2"));
    }
}

mod worked_example {
    use super::*;

    fn example() -> Archive {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("machine_data/g1_example");
        Archive::load(&files_of(&file).unwrap()).unwrap()
    }

    /// EX-01
    #[test]
    fn the_example_loads_as_it_stands_and_has_no_findings() {
        let archive = example();
        assert_eq!(check(&archive), []);
        let given = MachineData::axis_numbers().filter(|axis| archive.given_axis(*axis));
        assert_eq!(given.collect::<Vec<_>>(), [axis(1), axis(2), axis(3)]);
        assert_eq!(cycle_time(&archive.data), Time::from_millis(2));
        assert_eq!(archive.data.axis("XF"), Some(axis(3)));
    }

    #[test]
    fn the_example_has_the_values_of_the_manual() {
        let data = example().data;
        for (number, code) in [(1, 1), (3, 11)] {
            let axis = &data.axes[axis(number)];
            assert_eq!(axis.gantry_axis_type, code);
            let limits = [axis.gantry_pos_tol_warning, axis.gantry_pos_tol_error, axis.gantry_pos_tol_ref];
            assert_eq!((limits, axis.gantry_break_up), ([0.0, 1.0, 100.0], false));
            assert_eq!((axis.refp_cam_is_active, axis.refp_cam_dir_is_minus), (true, false));
            assert_eq!((axis.refp_move_dist[0], axis.refp_move_dist_corr[0], axis.refp_cam_shift[0]), (0.0, 0.0, 0.0));
            assert_eq!((axis.refp_set_pos[0], axis.enc_refp_mode[0]), (0.0, 1));
            assert!(!axis.refp_search_marker_reverse[0]);
        }
    }
}
