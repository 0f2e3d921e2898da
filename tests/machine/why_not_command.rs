//! `opennck why-not` as users call it.
#![cfg(feature = "cli")]

use std::fs;

use crate::cli::{directory, err, opennck, out};

/// The conditions of the tree are in the order in which the control tests them; each branch ends with a signal of another writer.
#[test]
fn why_not_names_what_the_control_waits_for() {
    let directory = directory("why_not");
    let enable = "\"X.position_measuring_system_1\" = 1, \"X.pulse_enable\" = 1, \"XF.position_measuring_system_1\" = 1, \
        \"XF.controller_enable\" = 1";
    let text = format!(
        "title = \"X has no controller enable\"\nmachine = \"g1_example\"\n[[step]]\nset = {{ {enable} }}\n[[step]]\nrun = \"300ms\"\n"
    );
    fs::write(directory.join("s.toml"), text).unwrap();
    let ask = |arguments: &[&str]| {
        let output = opennck(&[&["why-not", "s.toml"], arguments].concat(), &directory);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        out(&output)
    };
    let expected = "    0.300  X.position_controller_active (DB31.DBX61.5) is 0 (off), because
             ✗ X.controller_enable (DB31.DBX2.1) = 0, wanted 1: never changed
             ✗ X.pulses_enabled (DB31.DBX93.7) = 0, wanted 1 (disabled)
               ✗ X.controller_enable (DB31.DBX2.1) = 0, wanted 1: never changed
             ✗ XF.pulses_enabled (DB33.DBX93.7) = 0, wanted 1 (disabled)
               ✗ XF.pulse_enable (DB33.DBX21.7) = 0, wanted 1: never changed
";
    assert_eq!(ask(&["X.position_controller_active"]), expected);
    assert_eq!(ask(&["DB31.DBX61.5@300ms"]), expected);
    let complete = ask(&["X.position_controller_active@0.3", "--all"]);
    let words = "✓ XF.controller_enable (DB33.DBX2.1) = 1: changed last at 0.002 s by outside";
    assert!(complete.contains(words) && complete.contains("✗ X.controller_enable"), "{complete}");
    let one = ask(&["X.drive_ready"]);
    assert!(one.contains("X.drive_ready (DB31.DBX93.5) is 1; it becomes 0 with"), "{one}");
    let written = ask(&["X.pulse_enable"]);
    assert!(written.contains("is 1: the control does not write it; changed last at 0.002 s by outside"), "{written}");
    for (signal, words) in [
        ("X.position_controller_active@0.5", "expected a time up to 0.300 s"),
        ("X.measurement_active", "expected a signal with known conditions"),
        ("DB31.DBB61", "expected a signal of one bit"),
        ("X.position_controller_active@soon", "write `X.position_controller_active@0.3`"),
        ("X.controller_enabel", "did you mean `X.controller_enable`?"),
    ] {
        let output = opennck(&["why-not", "s.toml", signal], &directory);
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""), "{signal}");
        assert!(err(&output).contains(words), "{signal}: {}", err(&output));
    }
}

/// O-28: a byte of the PLC that is on its way is not what the control tests.
#[test]
fn why_not_tests_what_the_control_has_read() {
    let directory = directory("why_not_delay");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n[plant.machine]\nto_nck_delay = \"20ms\"\n\
        [[step]]\nrun = \"300ms\"\n[[step]]\nset = { \"Y.activate_handwheel_1\" = 1 }\n[[step]]\nrun = \"40ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let ask = |signal: &str| out(&opennck(&["why-not", "s.toml", signal], &directory));
    let late = ask("Y.handwheel_1_active@0.310");
    let words = "✗ Y.activate_handwheel_1 (DB32.DBX4.0) = 0, wanted 1: changed last at 0.302 s by outside, \
        on its way to the control (to_nck_delay)\n";
    assert!(late.starts_with("    0.310  Y.handwheel_1_active (DB32.DBX64.0) is 0 (none), because\n"), "{late}");
    assert!(late.contains(words), "{late}");
    let there = ask("Y.handwheel_1_active@0.330");
    assert!(there.contains("Y.handwheel_1_active (DB32.DBX64.0) is 1 (1); it becomes 0 with\n"), "{there}");
    assert!(there.contains("✗ Y.activate_handwheel_1 (DB32.DBX4.0) = 1, wanted 0: changed last"), "{there}");
}

/// A run that failed has an answer, with a warning; one that could not run has none.
#[test]
fn why_and_why_not_say_that_the_scenario_failed() {
    let directory = directory("why_not_failed");
    let head = "title = \"t\"\nmachine = \"g1_example\"\n";
    let fails = "plc = \"enable_all\"\n[[rule]]\nname = \"r\"\nwhen = \"alarm(25050)\"\nthen = \"M0.0\"\nmust_begin = true\n\
        [[step]]\nrun = \"100ms\"\n[[step]]\nexpect = \"M0.0\"\n[[step]]\nrun = \"100ms\"\n";
    fs::write(directory.join("fails.toml"), format!("{head}{fails}")).unwrap();
    let process = "plc = { process = \"no_such_program {image}\" }\n[[step]]\nrun = \"1s\"\n";
    fs::write(directory.join("unusable.toml"), format!("{head}{process}")).unwrap();
    for (command, signal, answer) in [
        ("why-not", "X.position_controller_active", "is 1 (on)"),
        ("why", "X.position_controller_active@1", "X.position_controller_active (DB31.DBX61.5)  0 -> 1  by nck"),
    ] {
        let output = opennck(&[command, "fails.toml", signal], &directory);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(out(&output).contains(answer), "{}", out(&output));
        let warning = "the scenario failed at 0.100 s: expected `M0.0`, but it is false; the answer is";
        assert!(err(&output).contains(warning) && err(&output).contains("that time"), "{}", err(&output));
        let output = opennck(&[command, "unusable.toml", signal], &directory);
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""));
        assert!(err(&output).contains("unusable.toml:3: the PLC process `no_such_program"), "{}", err(&output));
    }
    // Before the failure there is nothing to warn of, and a rule may still begin.
    let before = opennck(&["why-not", "fails.toml", "X.position_controller_active@0.09"], &directory);
    assert_eq!((before.status.code(), err(&before).as_str()), (Some(0), ""));
}

#[test]
fn why_not_explains_one_case_of_a_matrix_under_one_profile() {
    let directory = directory("why_not_case");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\nprofile = [\"840d_sl\", \"828d\"]\n\
        [matrix]\n\"10240\" = [0, 1]\n[[step]]\nrun = \"100ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let ask = |arguments: &[&str]| opennck(&[&["why-not", "s.toml"], arguments].concat(), &directory);
    for (case, value) in [("10240 = 0", "is 1; it becomes 0"), ("10240 = 1", "is 0, because")] {
        let output = ask(&["nck.inch_measuring_system_active", "--case", case]);
        let expected = format!("    0.100  nck.inch_measuring_system_active (DB10.DBX107.7) {value}");
        assert!(out(&output).starts_with(&expected), "{}{}", out(&output), err(&output));
    }
    let output = ask(&["DB3900.DBX1.6", "--case", "10240 = 1", "--profile", "828d"]);
    let expected = "    0.100  X.speed_controller_active (DB3900.DBX1.6) is 1 (on)";
    assert!(out(&output).starts_with(expected), "{}{}", out(&output), err(&output));
    for (arguments, words) in [
        (&["--case", "10240 = 2"][..], "cases are 10240 = 0; 10240 = 1"),
        (&[], "`--case TEXT`"),
        (&["--case", "10240 = 1", "--profile", "840d"], "profiles are 840d_sl, 828d and isg"),
    ] {
        let output = ask(&[&["X.axis_ready"], arguments].concat());
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""), "{arguments:?}");
        assert!(err(&output).contains(words), "{}", err(&output));
    }
    let why = opennck(&["why", "s.toml", "DB3900.DBX1.5@1", "--case", "10240 = 1", "--profile", "828d"], &directory);
    assert!(out(&why).contains("X.position_controller_active (DB3900.DBX1.5)  0 -> 1  by nck"), "{}", err(&why));
}

/// A fact shows what the control finds: the number of the measuring system, and the limit that applies in this phase of the grouping.
#[test]
fn why_not_shows_what_is_found_and_which_limit_applies() {
    let directory = directory("why_not_facts");
    let scenario = include_str!("../../golden/worked_example/gantry_references_and_synchronises.toml");
    fs::write(directory.join("s.toml"), scenario.replace("../../machine_data/", "")).unwrap();
    let ask = |signal: &str| out(&opennck(&["why-not", "s.toml", signal], &directory));
    let second = ask("X.position_measuring_system_2_activated@1");
    assert!(
        second.starts_with("    1.000  X.position_measuring_system_2_activated (DB31.DBX102.6) is 0 (1), because"),
        "{second}"
    );
    let not_synchronised = ask("XF.gantry_trip_limit_exceeded@1");
    assert!(not_synchronised.contains("wanted above 100.000000 (MD37130)"), "{not_synchronised}");
    let synchronised = ask("XF.gantry_trip_limit_exceeded");
    assert!(synchronised.contains("wanted above 1.000000 (MD37120)"), "{synchronised}");
}

/// O-03: an approach that an override of 0 % holds waits for the override, and for the next step of its own.
#[test]
fn why_not_names_the_override_that_holds_an_approach() {
    let directory = directory("why_not_override");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n\
        [[step]]\nset = { \"DB11.DBX0.2\" = 1, \"DB11.DBX1.2\" = 1 }\n\
        [[step]]\nwait = \"Y.position_controller_active && DB11.DBX7.2\"\n[[step]]\npulse = [\"Y.traversing_key_plus\"]\n\
        [[step]]\nset = { \"Y.override_active\" = 1, \"Y.feed_override\" = \"0%\" }\n[[step]]\nrun = \"300ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["why-not", "s.toml", "Y.referenced_synchronized_1"], &directory);
    assert!(out(&output).contains("✗ approach of Y: "), "{}{}", out(&output), err(&output));
    assert!(out(&output).contains("✗ effective override of Y: 0 %, wanted above 0 %\n"), "{}", out(&output));
}

/// A key is held and the axis stands: what new setpoints wait for, and what ends the traverse command (O-26).
#[test]
fn why_not_names_what_a_standing_axis_waits_for_and_what_ends_its_command() {
    let directory = directory("why_not_standing");
    let ask = |step: &str, signal: &str| {
        let scenario = format!(
            "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n[[step]]\nrun = \"100ms\"\n\
             [[step]]\n{step}\n[[step]]\nset = {{ \"X.traversing_key_plus\" = 1 }}\n[[step]]\nrun = \"100ms\"\n"
        );
        fs::write(directory.join("s.toml"), scenario).unwrap();
        let output = opennck(&["why-not", "s.toml", signal], &directory);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        out(&output)
    };
    let setpoints = "✗ new setpoints are output to the drive of X: no, wanted yes\n";
    for (step, words) in [
        ("set = { \"XF.feed_stop\" = 1 }", "✗ XF.feed_stop (DB33.DBX4.3) = 1, wanted 0: changed last at"),
        ("set = { \"CHAN1.feed_disable\" = 1 }", "✗ CHAN1.feed_disable (DB21.DBX6.0) = 1, wanted 0: changed last at"),
        (
            "set = { \"X.override_active\" = 1, \"X.feed_override\" = \"0%\" }",
            "✗ effective override of X: 0 %, wanted above 0 %",
        ),
        (
            "force = { \"XF.controller_enable\" = 0 }",
            "✗ XF.controller_enable (DB33.DBX2.1) = 0, wanted 1: changed last at",
        ),
    ] {
        let tree = ask(step, "X.axis_stationary");
        assert!(tree.contains("X.axis_stationary (DB31.DBX61.4) is 1; it becomes 0 with\n"), "{step}\n{tree}");
        assert!(tree.contains(setpoints) && tree.contains(words), "{step}\n{tree}");
    }
    let command = ["X.traverse_command_plus", "XF.traverse_command_plus"].map(|signal| ask("run = \"2ms\"", signal));
    for words in [
        "is 1 (plus); it becomes 0 with\n",
        "✗ mode_group_1.active_mode_jog (DB11.DBX6.2) = 1, wanted 0\n",
        "✗ mode_group_1.active_machine_function_ref (DB11.DBX7.2) = 0, wanted 1\n",
        "✗ X.machine_function_increment_1 (DB31.DBX5.0) = 0, wanted 1: never changed\n",
        "✗ X.controller_enable (DB31.DBX2.1) = 1, wanted 0: changed last at",
        "✗ XF.controller_enable (DB33.DBX2.1) = 1, wanted 0: changed last at",
        "✗ XF.pulses_enabled (DB33.DBX93.7) = 1, wanted 0\n",
        "✗ X.traversing_key_plus (DB31.DBX4.7) = 1, wanted 0: changed last at",
    ] {
        assert!(command.iter().all(|tree| tree.contains(words)), "{words}\n{}{}", command[0], command[1]);
    }
    assert!(!command[0].contains("wanted not plus"), "{}", command[0]);
    // An enable that is missing from the beginning is waited for: its loss cannot end the command.
    let waiting = ask("force = { \"XF.controller_enable\" = 0 }", "X.traverse_command_plus");
    assert!(waiting.contains("is 1 (plus)") && !waiting.contains("controller_enable"), "{waiting}");
}

/// The grouping of the page for commissioning engineers: an alarm that RESET clears stands before parking, which loses the reference.
#[test]
fn why_not_names_a_pending_alarm_before_what_contradicts_the_goal() {
    let directory = directory("why_not_order");
    let page = include_str!("../../docs/commissioning_engineer.md");
    let (_, scenario) = page.split_once("```toml\n# jammed.toml\n").unwrap();
    fs::write(directory.join("jammed.toml"), scenario.split_once("```").unwrap().0).unwrap();
    let output = opennck(&["why-not", "jammed.toml", "X.gantry_grouping_is_synchronized"], &directory);
    let tree = out(&output);
    let at = |words: &str| tree.find(words).unwrap_or_else(|| panic!("{words} in {tree}"));
    let alarm = at("alarm of XF with the reaction follow-up: 25050 [XF], cleared by mode group RESET, wanted none\n");
    assert!(alarm < at("X.position_measuring_system_1 (DB31.DBX1.5) = 1, wanted 0"), "{tree}");
}

/// REF-14: a signal that was set too early must rise again.
#[test]
fn why_not_names_the_signal_that_must_rise() {
    let directory = directory("why_not_rises");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n\
        [[step]]\nset = { \"DB11.DBX0.2\" = 1, \"DB11.DBX1.2\" = 1, \"X.start_gantry_synchronization\" = 1 }\n\
        [[step]]\nwait = \"X.position_controller_active\"\n[[step]]\npulse = [\"X.traversing_key_plus\"]\n\
        [[step]]\nwait = \"alarm(10654)\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let tree = out(&opennck(&["why-not", "s.toml", "X.gantry_grouping_is_synchronized"], &directory));
    let words = "✗ X.start_gantry_synchronization (DB31.DBX29.4) rises: it was 0 before: no, wanted yes\n";
    assert!(tree.contains(words), "{tree}");
}

/// REF-14: what moves the axes of a grouping that waits in section 3 is the start, beside the key of another approach.
#[test]
fn why_not_names_the_start_of_section_3_for_the_traverse_commands_of_its_axes() {
    let directory = directory("why_not_section_3");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n\
        [[step]]\nset = { \"DB11.DBX0.2\" = 1, \"DB11.DBX1.2\" = 1 }\n\
        [[step]]\nwait = \"X.position_controller_active\"\n[[step]]\npulse = [\"X.traversing_key_plus\"]\n\
        [[step]]\nwait = \"alarm(10654)\"\n[[step]]\nrun = \"100ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    for signal in ["X.traverse_command_minus", "XF.traverse_command_minus", "XF.traverse_request_minus"] {
        let tree = out(&opennck(&["why-not", "s.toml", signal], &directory));
        let words = "✗ X.start_gantry_synchronization (DB31.DBX29.4) = 0, wanted 1: never changed\n";
        assert!(tree.contains(words), "{signal}: {tree}");
    }
}

/// An axis with a handwheel waits for its pulses, beside a key.
#[test]
fn why_not_names_the_pulses_of_a_handwheel() {
    let directory = directory("why_not_handwheel");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n[[step]]\nrun = \"100ms\"\n\
        [[step]]\nset = { \"Y.activate_handwheel_2\" = 1, \"Y.machine_function_increment_100\" = 1 }\n[[step]]\nrun = \"100ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["why-not", "s.toml", "Y.traverse_command_plus"], &directory);
    let tree = out(&output);
    assert!(tree.contains("✗ pulses of handwheel 2 for Y: none, wanted plus\n"), "{tree}{}", err(&output));
    assert!(tree.contains("Y.traversing_key_plus (DB32.DBX4.7) = 0, wanted 1"), "{tree}");
}

/// A window at rest shows MD36012, which multiplies it: 0.01 mm times 2.
#[test]
fn why_not_names_the_factor_of_a_window_at_rest() {
    let directory = directory("why_not_window");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n\
        [machine_data]\n\"MD36012[Y]\" = 2\n[[step]]\nrun = \"1ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["why-not", "s.toml", "Y.position_reached_exact_stop_fine", "--all"], &directory);
    assert!(out(&output).contains("at most 0.020000 (MD36010 × MD36012[0])"), "{}{}", out(&output), err(&output));
}

/// A misspelt filter of a catalogue.
#[test]
fn a_catalogue_without_a_matching_row_names_the_nearest_word() {
    let directory = directory("near_words");
    for (arguments, words) in [
        (&["signals", "trip_limit_exeeded"][..], "did you mean `trip_limit_exceeded`?"),
        (&["signals", "folow_up_active"][..], "did you mean `follow_up_active`?"),
        (&["machine-data", "list", "GANTRY_POS_TOL_EROR"][..], "did you mean `gantry_pos_tol_error`?"),
        (&["rule", "FOO"][..], "omit the filter to list all rows"),
        (&["signals", "qqqqqqqq"][..], "omit the filter to list all signals"),
    ] {
        let output = opennck(arguments, &directory);
        assert!(output.status.code() == Some(1) && err(&output).contains(words), "{arguments:?}: {}", err(&output));
    }
}

/// Functions beside JOG and referencing: each tree names what the function waits for, and not what waits for another one.
#[test]
fn why_not_knows_spindles_brakes_positioning_tests_and_overlays() {
    let project = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    for (scenario, signal, words, not) in [
        // Accelerating to S600.
        ("spindle/stops", "SP1.spindle_in_setpoint_range@0.06", "within 10 % (MD35150) of 600.000000 rev/min", "M5"),
        (
            "spindle/stops",
            "X.axis_stationary@0.15",
            "what the path of CHAN1 waits for: the speed of its spindles",
            "feed_stop",
        ),
        (
            "spindle/positioning",
            "SP1.spindle_in_position@0.2",
            "the target of SP1 is known: its zero mark was passed: no",
            "jog",
        ),
        (
            "spindle/m3_m4_m5",
            "SP1.traverse_command_plus@0.05",
            "function of SP1: M3 S600, direction plus",
            "traversing_key",
        ),
        (
            "spindle/keys_and_chuck_speed",
            "SP1.traverse_command_plus@0.05",
            "SP1.traversing_key_plus (DB33.DBX4.7) = 1, wanted 0: changed last at 0.036 s by outside",
            "M3",
        ),
        // At the end the PLC no longer opens it by 20.5, and 25030 switches the axis off.
        (
            "brake/vertical_axis_with_brake",
            "Y.holding_brake_open",
            "alarm of Y with the reaction follow-up: 25030 [Y]",
            "X.",
        ),
        (
            "exchange/positioning_stopped",
            "X.traverse_command_plus@1.5",
            "positioning of X: by the PLC",
            "traversing_key",
        ),
        (
            "program/program_test_of_axes",
            "CHAN1.program_test_active@0.05",
            "activate_program_test (DB21.DBX1.7) = 1, wanted 0",
            "X.",
        ),
        (
            "overlay/drf_of_a_grouping",
            "X.handwheel_1_active@7.9",
            "CHAN1.activate_drf (DB21.DBX0.3) = 0, wanted 1",
            "Y.",
        ),
        (
            "start_up/function_generator_refused",
            "Y.position_reached_exact_stop_fine@0.062",
            "movement of Y beside its setpoint: the function generator, wanted none",
            "deviation",
        ),
    ] {
        let file = format!("golden/{scenario}.toml");
        let output = opennck(&["why-not", &file, signal], &project);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        let tree = out(&output);
        let (head, below) = tree.split_once('\n').unwrap();
        assert!(below.contains(words) && !below.contains(not), "{scenario} {signal}\n{head}\n{below}");
    }
}

/// A block that waits for an axis on its own way names what holds that axis: feed stop, override, enable; also behind POSA, by WAITP.
#[test]
fn a_block_that_waits_for_a_positioning_axis_names_what_holds_it() {
    let directory = directory("why_not_positioning");
    let feed_stop = "✗ Y.feed_stop (DB32.DBX4.3) = 1, wanted 0";
    for (file, nc, force, words) in [
        ("stop", "N10 POS[Y]=50 FA[Y]=3000", "\"Y.feed_stop\" = 1", feed_stop),
        ("posa", "N10 POSA[Y]=50 FA[Y]=3000\nN20 WAITP(Y)", "\"Y.feed_stop\" = 1", feed_stop),
        (
            "override",
            "N10 POS[Y]=50 FA[Y]=3000",
            "\"Y.feed_override\" = \"0%\", \"Y.override_active\" = 1",
            "✗ effective override of Y: 0 %, wanted above 0 %",
        ),
        (
            "enable",
            "N10 POS[Y]=50 FA[Y]=3000",
            "\"Y.controller_enable\" = 0",
            "✗ Y.position_controller_active (DB32.DBX61.5) = 0, wanted 1",
        ),
    ] {
        let scenario = format!(
            "title = \"t\"\nmachine = \"portal\"\nplc = \"enable_all\"\nnc = '''\n{nc}\nM30\n'''\n\
             [[step]]\nrun = \"100ms\"\n[[step]]\nset = {{ \"DB11.DBX0.0\" = 1 }}\n[[step]]\nforce = {{ {force} }}\n\
             [[step]]\nrun = \"300ms\"\n[[step]]\npulse = \"CHAN1.nc_start\"\nfor = \"20ms\"\n[[step]]\nrun = \"500ms\"\n"
        );
        fs::write(directory.join(file), scenario).unwrap();
        let output = opennck(&["why-not", file, "CHAN1.m2_m30_active"], &directory);
        assert!(out(&output).contains(words), "{file}: {}{}", out(&output), err(&output));
    }
}
