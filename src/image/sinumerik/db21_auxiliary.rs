//! DB21 to DB30, bytes 58 to 271: the auxiliary functions and G functions that a channel outputs to the PLC.
//!
//! Values stay until the next output of their place; the change bits and the decoded M functions are 1 for one PLC cycle.

use crate::image::table::signals;

signals! {
    /// DB21 bytes 58 to 271: auxiliary functions and active G functions of the channel.
    pub struct ChannelAuxiliary, channel_auxiliary: Channel, Nck, 58 to 271;

    /// M function 1 change: 1 for one PLC cycle with a new M function at place 1.
    bool, m_function_1_change, set_m_function_1_change: 58, 0;
    /// M function 2 change: 1 for one PLC cycle with a new M function at place 2.
    bool, m_function_2_change, set_m_function_2_change: 58, 1;
    /// M function 3 change: 1 for one PLC cycle with a new M function at place 3.
    bool, m_function_3_change, set_m_function_3_change: 58, 2;
    /// M function 4 change: 1 for one PLC cycle with a new M function at place 4.
    bool, m_function_4_change, set_m_function_4_change: 58, 3;
    /// M function 5 change: 1 for one PLC cycle with a new M function at place 5.
    bool, m_function_5_change, set_m_function_5_change: 58, 4;
    /// M function 1 not decoded: 1 for one PLC cycle with an M function that has no decoded signal.
    bool, m_function_1_not_decoded, set_m_function_1_not_decoded: 59, 0;
    /// M function 2 not decoded: 1 for one PLC cycle with an M function that has no decoded signal.
    bool, m_function_2_not_decoded, set_m_function_2_not_decoded: 59, 1;
    /// M function 3 not decoded: 1 for one PLC cycle with an M function that has no decoded signal.
    bool, m_function_3_not_decoded, set_m_function_3_not_decoded: 59, 2;
    /// M function 4 not decoded: 1 for one PLC cycle with an M function that has no decoded signal.
    bool, m_function_4_not_decoded, set_m_function_4_not_decoded: 59, 3;
    /// M function 5 not decoded: 1 for one PLC cycle with an M function that has no decoded signal.
    bool, m_function_5_not_decoded, set_m_function_5_not_decoded: 59, 4;
    /// S function 1 change: 1 for one PLC cycle with a new S function at place 1.
    bool, s_function_1_change, set_s_function_1_change: 60, 0;
    /// S function 2 change: 1 for one PLC cycle with a new S function at place 2.
    bool, s_function_2_change, set_s_function_2_change: 60, 1;
    /// S function 3 change: 1 for one PLC cycle with a new S function at place 3.
    bool, s_function_3_change, set_s_function_3_change: 60, 2;
    /// S function 1 quick: 1 = output with quick acknowledgement.
    bool, s_function_1_quick, set_s_function_1_quick: 60, 4;
    /// S function 2 quick: 1 = output with quick acknowledgement.
    bool, s_function_2_quick, set_s_function_2_quick: 60, 5;
    /// S function 3 quick: 1 = output with quick acknowledgement.
    bool, s_function_3_quick, set_s_function_3_quick: 60, 6;
    /// T function 1 change: 1 for one PLC cycle with a new T function at place 1.
    bool, t_function_1_change, set_t_function_1_change: 61, 0;
    /// T function 2 change: 1 for one PLC cycle with a new T function at place 2.
    bool, t_function_2_change, set_t_function_2_change: 61, 1;
    /// T function 3 change: 1 for one PLC cycle with a new T function at place 3.
    bool, t_function_3_change, set_t_function_3_change: 61, 2;
    /// T function 1 quick: 1 = output with quick acknowledgement.
    bool, t_function_1_quick, set_t_function_1_quick: 61, 4;
    /// T function 2 quick: 1 = output with quick acknowledgement.
    bool, t_function_2_quick, set_t_function_2_quick: 61, 5;
    /// T function 3 quick: 1 = output with quick acknowledgement.
    bool, t_function_3_quick, set_t_function_3_quick: 61, 6;
    /// D function 1 change: 1 for one PLC cycle with a new D function at place 1.
    bool, d_function_1_change, set_d_function_1_change: 62, 0;
    /// D function 2 change: 1 for one PLC cycle with a new D function at place 2.
    bool, d_function_2_change, set_d_function_2_change: 62, 1;
    /// D function 3 change: 1 for one PLC cycle with a new D function at place 3.
    bool, d_function_3_change, set_d_function_3_change: 62, 2;
    /// D function 1 quick: 1 = output with quick acknowledgement.
    bool, d_function_1_quick, set_d_function_1_quick: 62, 4;
    /// D function 2 quick: 1 = output with quick acknowledgement.
    bool, d_function_2_quick, set_d_function_2_quick: 62, 5;
    /// D function 3 quick: 1 = output with quick acknowledgement.
    bool, d_function_3_quick, set_d_function_3_quick: 62, 6;
    /// DL function change: 1 for one PLC cycle with a new DL function.
    bool, dl_function_change, set_dl_function_change: 63, 0;
    /// DL function quick: 1 = output with quick acknowledgement.
    bool, dl_function_quick, set_dl_function_quick: 63, 4;
    /// H function 1 change: 1 for one PLC cycle with a new H function at place 1.
    bool, h_function_1_change, set_h_function_1_change: 64, 0;
    /// H function 2 change: 1 for one PLC cycle with a new H function at place 2.
    bool, h_function_2_change, set_h_function_2_change: 64, 1;
    /// H function 3 change: 1 for one PLC cycle with a new H function at place 3.
    bool, h_function_3_change, set_h_function_3_change: 64, 2;
    /// H function 1 quick: 1 = output with quick acknowledgement.
    bool, h_function_1_quick, set_h_function_1_quick: 64, 4;
    /// H function 2 quick: 1 = output with quick acknowledgement.
    bool, h_function_2_quick, set_h_function_2_quick: 64, 5;
    /// H function 3 quick: 1 = output with quick acknowledgement.
    bool, h_function_3_quick, set_h_function_3_quick: 64, 6;
    /// F function 1 change: 1 for one PLC cycle with a new F function at place 1.
    bool, f_function_1_change, set_f_function_1_change: 65, 0;
    /// F function 2 change: 1 for one PLC cycle with a new F function at place 2.
    bool, f_function_2_change, set_f_function_2_change: 65, 1;
    /// F function 3 change: 1 for one PLC cycle with a new F function at place 3.
    bool, f_function_3_change, set_f_function_3_change: 65, 2;
    /// F function 4 change: 1 for one PLC cycle with a new F function at place 4.
    bool, f_function_4_change, set_f_function_4_change: 65, 3;
    /// F function 5 change: 1 for one PLC cycle with a new F function at place 5.
    bool, f_function_5_change, set_f_function_5_change: 65, 4;
    /// F function 6 change: 1 for one PLC cycle with a new F function at place 6.
    bool, f_function_6_change, set_f_function_6_change: 65, 5;
    /// M function 1 quick: 1 = output with quick acknowledgement.
    bool, m_function_1_quick, set_m_function_1_quick: 66, 0;
    /// M function 2 quick: 1 = output with quick acknowledgement.
    bool, m_function_2_quick, set_m_function_2_quick: 66, 1;
    /// M function 3 quick: 1 = output with quick acknowledgement.
    bool, m_function_3_quick, set_m_function_3_quick: 66, 2;
    /// M function 4 quick: 1 = output with quick acknowledgement.
    bool, m_function_4_quick, set_m_function_4_quick: 66, 3;
    /// M function 5 quick: 1 = output with quick acknowledgement.
    bool, m_function_5_quick, set_m_function_5_quick: 66, 4;
    /// F function 1 quick: 1 = output with quick acknowledgement.
    bool, f_function_1_quick, set_f_function_1_quick: 67, 0;
    /// F function 2 quick: 1 = output with quick acknowledgement.
    bool, f_function_2_quick, set_f_function_2_quick: 67, 1;
    /// F function 3 quick: 1 = output with quick acknowledgement.
    bool, f_function_3_quick, set_f_function_3_quick: 67, 2;
    /// F function 4 quick: 1 = output with quick acknowledgement.
    bool, f_function_4_quick, set_f_function_4_quick: 67, 3;
    /// F function 5 quick: 1 = output with quick acknowledgement.
    bool, f_function_5_quick, set_f_function_5_quick: 67, 4;
    /// F function 6 quick: 1 = output with quick acknowledgement.
    bool, f_function_6_quick, set_f_function_6_quick: 67, 5;
    /// Extension of D function 1: the spindle or tool holder.
    u8, d_function_1_extension, set_d_function_1_extension: 128, 7 to 0;
    /// D function 1: the number of the tool offset.
    u8, d_function_1, set_d_function_1: 129, 7 to 0;
    /// Extension of D function 2: the spindle or tool holder.
    u8, d_function_2_extension, set_d_function_2_extension: 130, 7 to 0;
    /// D function 2: the number of the tool offset.
    u8, d_function_2, set_d_function_2: 131, 7 to 0;
    /// Extension of D function 3: the spindle or tool holder.
    u8, d_function_3_extension, set_d_function_3_extension: 132, 7 to 0;
    /// D function 3: the number of the tool offset.
    u8, d_function_3, set_d_function_3: 133, 7 to 0;
    /// Decoded M function M0: 1 for one PLC cycle.
    bool, decoded_m_function_0, set_decoded_m_function_0: 194, 0;
    /// Decoded M function M1: 1 for one PLC cycle.
    bool, decoded_m_function_1, set_decoded_m_function_1: 194, 1;
    /// Decoded M function M2: 1 for one PLC cycle.
    bool, decoded_m_function_2, set_decoded_m_function_2: 194, 2;
    /// Decoded M function M3: 1 for one PLC cycle.
    bool, decoded_m_function_3, set_decoded_m_function_3: 194, 3;
    /// Decoded M function M4: 1 for one PLC cycle.
    bool, decoded_m_function_4, set_decoded_m_function_4: 194, 4;
    /// Decoded M function M5: 1 for one PLC cycle.
    bool, decoded_m_function_5, set_decoded_m_function_5: 194, 5;
    /// Decoded M function M6: 1 for one PLC cycle.
    bool, decoded_m_function_6, set_decoded_m_function_6: 194, 6;
    /// Decoded M function M7: 1 for one PLC cycle.
    bool, decoded_m_function_7, set_decoded_m_function_7: 194, 7;
    /// Decoded M function M8: 1 for one PLC cycle.
    bool, decoded_m_function_8, set_decoded_m_function_8: 195, 0;
    /// Decoded M function M9: 1 for one PLC cycle.
    bool, decoded_m_function_9, set_decoded_m_function_9: 195, 1;
    /// Decoded M function M10: 1 for one PLC cycle.
    bool, decoded_m_function_10, set_decoded_m_function_10: 195, 2;
    /// Decoded M function M11: 1 for one PLC cycle.
    bool, decoded_m_function_11, set_decoded_m_function_11: 195, 3;
    /// Decoded M function M12: 1 for one PLC cycle.
    bool, decoded_m_function_12, set_decoded_m_function_12: 195, 4;
    /// Decoded M function M13: 1 for one PLC cycle.
    bool, decoded_m_function_13, set_decoded_m_function_13: 195, 5;
    /// Decoded M function M14: 1 for one PLC cycle.
    bool, decoded_m_function_14, set_decoded_m_function_14: 195, 6;
    /// Decoded M function M15: 1 for one PLC cycle.
    bool, decoded_m_function_15, set_decoded_m_function_15: 195, 7;
    /// Decoded M function M16: 1 for one PLC cycle.
    bool, decoded_m_function_16, set_decoded_m_function_16: 196, 0;
    /// Decoded M function M17: 1 for one PLC cycle.
    bool, decoded_m_function_17, set_decoded_m_function_17: 196, 1;
    /// Decoded M function M18: 1 for one PLC cycle.
    bool, decoded_m_function_18, set_decoded_m_function_18: 196, 2;
    /// Decoded M function M19: 1 for one PLC cycle.
    bool, decoded_m_function_19, set_decoded_m_function_19: 196, 3;
    /// Decoded M function M20: 1 for one PLC cycle.
    bool, decoded_m_function_20, set_decoded_m_function_20: 196, 4;
    /// Decoded M function M21: 1 for one PLC cycle.
    bool, decoded_m_function_21, set_decoded_m_function_21: 196, 5;
    /// Decoded M function M22: 1 for one PLC cycle.
    bool, decoded_m_function_22, set_decoded_m_function_22: 196, 6;
    /// Decoded M function M23: 1 for one PLC cycle.
    bool, decoded_m_function_23, set_decoded_m_function_23: 196, 7;
    /// Decoded M function M24: 1 for one PLC cycle.
    bool, decoded_m_function_24, set_decoded_m_function_24: 197, 0;
    /// Decoded M function M25: 1 for one PLC cycle.
    bool, decoded_m_function_25, set_decoded_m_function_25: 197, 1;
    /// Decoded M function M26: 1 for one PLC cycle.
    bool, decoded_m_function_26, set_decoded_m_function_26: 197, 2;
    /// Decoded M function M27: 1 for one PLC cycle.
    bool, decoded_m_function_27, set_decoded_m_function_27: 197, 3;
    /// Decoded M function M28: 1 for one PLC cycle.
    bool, decoded_m_function_28, set_decoded_m_function_28: 197, 4;
    /// Decoded M function M29: 1 for one PLC cycle.
    bool, decoded_m_function_29, set_decoded_m_function_29: 197, 5;
    /// Decoded M function M30: 1 for one PLC cycle.
    bool, decoded_m_function_30, set_decoded_m_function_30: 197, 6;
    /// Decoded M function M31: 1 for one PLC cycle.
    bool, decoded_m_function_31, set_decoded_m_function_31: 197, 7;
    /// Decoded M function M32: 1 for one PLC cycle.
    bool, decoded_m_function_32, set_decoded_m_function_32: 198, 0;
    /// Decoded M function M33: 1 for one PLC cycle.
    bool, decoded_m_function_33, set_decoded_m_function_33: 198, 1;
    /// Decoded M function M34: 1 for one PLC cycle.
    bool, decoded_m_function_34, set_decoded_m_function_34: 198, 2;
    /// Decoded M function M35: 1 for one PLC cycle.
    bool, decoded_m_function_35, set_decoded_m_function_35: 198, 3;
    /// Decoded M function M36: 1 for one PLC cycle.
    bool, decoded_m_function_36, set_decoded_m_function_36: 198, 4;
    /// Decoded M function M37: 1 for one PLC cycle.
    bool, decoded_m_function_37, set_decoded_m_function_37: 198, 5;
    /// Decoded M function M38: 1 for one PLC cycle.
    bool, decoded_m_function_38, set_decoded_m_function_38: 198, 6;
    /// Decoded M function M39: 1 for one PLC cycle.
    bool, decoded_m_function_39, set_decoded_m_function_39: 198, 7;
    /// Decoded M function M40: 1 for one PLC cycle.
    bool, decoded_m_function_40, set_decoded_m_function_40: 199, 0;
    /// Decoded M function M41: 1 for one PLC cycle.
    bool, decoded_m_function_41, set_decoded_m_function_41: 199, 1;
    /// Decoded M function M42: 1 for one PLC cycle.
    bool, decoded_m_function_42, set_decoded_m_function_42: 199, 2;
    /// Decoded M function M43: 1 for one PLC cycle.
    bool, decoded_m_function_43, set_decoded_m_function_43: 199, 3;
    /// Decoded M function M44: 1 for one PLC cycle.
    bool, decoded_m_function_44, set_decoded_m_function_44: 199, 4;
    /// Decoded M function M45: 1 for one PLC cycle.
    bool, decoded_m_function_45, set_decoded_m_function_45: 199, 5;
    /// Decoded M function M46: 1 for one PLC cycle.
    bool, decoded_m_function_46, set_decoded_m_function_46: 199, 6;
    /// Decoded M function M47: 1 for one PLC cycle.
    bool, decoded_m_function_47, set_decoded_m_function_47: 199, 7;
    /// Decoded M function M48: 1 for one PLC cycle.
    bool, decoded_m_function_48, set_decoded_m_function_48: 200, 0;
    /// Decoded M function M49: 1 for one PLC cycle.
    bool, decoded_m_function_49, set_decoded_m_function_49: 200, 1;
    /// Decoded M function M50: 1 for one PLC cycle.
    bool, decoded_m_function_50, set_decoded_m_function_50: 200, 2;
    /// Decoded M function M51: 1 for one PLC cycle.
    bool, decoded_m_function_51, set_decoded_m_function_51: 200, 3;
    /// Decoded M function M52: 1 for one PLC cycle.
    bool, decoded_m_function_52, set_decoded_m_function_52: 200, 4;
    /// Decoded M function M53: 1 for one PLC cycle.
    bool, decoded_m_function_53, set_decoded_m_function_53: 200, 5;
    /// Decoded M function M54: 1 for one PLC cycle.
    bool, decoded_m_function_54, set_decoded_m_function_54: 200, 6;
    /// Decoded M function M55: 1 for one PLC cycle.
    bool, decoded_m_function_55, set_decoded_m_function_55: 200, 7;
    /// Decoded M function M56: 1 for one PLC cycle.
    bool, decoded_m_function_56, set_decoded_m_function_56: 201, 0;
    /// Decoded M function M57: 1 for one PLC cycle.
    bool, decoded_m_function_57, set_decoded_m_function_57: 201, 1;
    /// Decoded M function M58: 1 for one PLC cycle.
    bool, decoded_m_function_58, set_decoded_m_function_58: 201, 2;
    /// Decoded M function M59: 1 for one PLC cycle.
    bool, decoded_m_function_59, set_decoded_m_function_59: 201, 3;
    /// Decoded M function M60: 1 for one PLC cycle.
    bool, decoded_m_function_60, set_decoded_m_function_60: 201, 4;
    /// Decoded M function M61: 1 for one PLC cycle.
    bool, decoded_m_function_61, set_decoded_m_function_61: 201, 5;
    /// Decoded M function M62: 1 for one PLC cycle.
    bool, decoded_m_function_62, set_decoded_m_function_62: 201, 6;
    /// Decoded M function M63: 1 for one PLC cycle.
    bool, decoded_m_function_63, set_decoded_m_function_63: 201, 7;
    /// Decoded M function M64: 1 for one PLC cycle.
    bool, decoded_m_function_64, set_decoded_m_function_64: 202, 0;
    /// Decoded M function M65: 1 for one PLC cycle.
    bool, decoded_m_function_65, set_decoded_m_function_65: 202, 1;
    /// Decoded M function M66: 1 for one PLC cycle.
    bool, decoded_m_function_66, set_decoded_m_function_66: 202, 2;
    /// Decoded M function M67: 1 for one PLC cycle.
    bool, decoded_m_function_67, set_decoded_m_function_67: 202, 3;
    /// Decoded M function M68: 1 for one PLC cycle.
    bool, decoded_m_function_68, set_decoded_m_function_68: 202, 4;
    /// Decoded M function M69: 1 for one PLC cycle.
    bool, decoded_m_function_69, set_decoded_m_function_69: 202, 5;
    /// Decoded M function M70: 1 for one PLC cycle.
    bool, decoded_m_function_70, set_decoded_m_function_70: 202, 6;
    /// Decoded M function M71: 1 for one PLC cycle.
    bool, decoded_m_function_71, set_decoded_m_function_71: 202, 7;
    /// Decoded M function M72: 1 for one PLC cycle.
    bool, decoded_m_function_72, set_decoded_m_function_72: 203, 0;
    /// Decoded M function M73: 1 for one PLC cycle.
    bool, decoded_m_function_73, set_decoded_m_function_73: 203, 1;
    /// Decoded M function M74: 1 for one PLC cycle.
    bool, decoded_m_function_74, set_decoded_m_function_74: 203, 2;
    /// Decoded M function M75: 1 for one PLC cycle.
    bool, decoded_m_function_75, set_decoded_m_function_75: 203, 3;
    /// Decoded M function M76: 1 for one PLC cycle.
    bool, decoded_m_function_76, set_decoded_m_function_76: 203, 4;
    /// Decoded M function M77: 1 for one PLC cycle.
    bool, decoded_m_function_77, set_decoded_m_function_77: 203, 5;
    /// Decoded M function M78: 1 for one PLC cycle.
    bool, decoded_m_function_78, set_decoded_m_function_78: 203, 6;
    /// Decoded M function M79: 1 for one PLC cycle.
    bool, decoded_m_function_79, set_decoded_m_function_79: 203, 7;
    /// Decoded M function M80: 1 for one PLC cycle.
    bool, decoded_m_function_80, set_decoded_m_function_80: 204, 0;
    /// Decoded M function M81: 1 for one PLC cycle.
    bool, decoded_m_function_81, set_decoded_m_function_81: 204, 1;
    /// Decoded M function M82: 1 for one PLC cycle.
    bool, decoded_m_function_82, set_decoded_m_function_82: 204, 2;
    /// Decoded M function M83: 1 for one PLC cycle.
    bool, decoded_m_function_83, set_decoded_m_function_83: 204, 3;
    /// Decoded M function M84: 1 for one PLC cycle.
    bool, decoded_m_function_84, set_decoded_m_function_84: 204, 4;
    /// Decoded M function M85: 1 for one PLC cycle.
    bool, decoded_m_function_85, set_decoded_m_function_85: 204, 5;
    /// Decoded M function M86: 1 for one PLC cycle.
    bool, decoded_m_function_86, set_decoded_m_function_86: 204, 6;
    /// Decoded M function M87: 1 for one PLC cycle.
    bool, decoded_m_function_87, set_decoded_m_function_87: 204, 7;
    /// Decoded M function M88: 1 for one PLC cycle.
    bool, decoded_m_function_88, set_decoded_m_function_88: 205, 0;
    /// Decoded M function M89: 1 for one PLC cycle.
    bool, decoded_m_function_89, set_decoded_m_function_89: 205, 1;
    /// Decoded M function M90: 1 for one PLC cycle.
    bool, decoded_m_function_90, set_decoded_m_function_90: 205, 2;
    /// Decoded M function M91: 1 for one PLC cycle.
    bool, decoded_m_function_91, set_decoded_m_function_91: 205, 3;
    /// Decoded M function M92: 1 for one PLC cycle.
    bool, decoded_m_function_92, set_decoded_m_function_92: 205, 4;
    /// Decoded M function M93: 1 for one PLC cycle.
    bool, decoded_m_function_93, set_decoded_m_function_93: 205, 5;
    /// Decoded M function M94: 1 for one PLC cycle.
    bool, decoded_m_function_94, set_decoded_m_function_94: 205, 6;
    /// Decoded M function M95: 1 for one PLC cycle.
    bool, decoded_m_function_95, set_decoded_m_function_95: 205, 7;
    /// Decoded M function M96: 1 for one PLC cycle.
    bool, decoded_m_function_96, set_decoded_m_function_96: 206, 0;
    /// Decoded M function M97: 1 for one PLC cycle.
    bool, decoded_m_function_97, set_decoded_m_function_97: 206, 1;
    /// Decoded M function M98: 1 for one PLC cycle.
    bool, decoded_m_function_98, set_decoded_m_function_98: 206, 2;
    /// Decoded M function M99: 1 for one PLC cycle.
    bool, decoded_m_function_99, set_decoded_m_function_99: 206, 3;
    /// Active G function of group 1: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_1, set_active_g_function_of_group_1: 208, 7 to 0;
    /// Active G function of group 2: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_2, set_active_g_function_of_group_2: 209, 7 to 0;
    /// Active G function of group 3: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_3, set_active_g_function_of_group_3: 210, 7 to 0;
    /// Active G function of group 4: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_4, set_active_g_function_of_group_4: 211, 7 to 0;
    /// Active G function of group 5: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_5, set_active_g_function_of_group_5: 212, 7 to 0;
    /// Active G function of group 6: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_6, set_active_g_function_of_group_6: 213, 7 to 0;
    /// Active G function of group 7: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_7, set_active_g_function_of_group_7: 214, 7 to 0;
    /// Active G function of group 8: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_8, set_active_g_function_of_group_8: 215, 7 to 0;
    /// Active G function of group 9: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_9, set_active_g_function_of_group_9: 216, 7 to 0;
    /// Active G function of group 10: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_10, set_active_g_function_of_group_10: 217, 7 to 0;
    /// Active G function of group 11: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_11, set_active_g_function_of_group_11: 218, 7 to 0;
    /// Active G function of group 12: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_12, set_active_g_function_of_group_12: 219, 7 to 0;
    /// Active G function of group 13: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_13, set_active_g_function_of_group_13: 220, 7 to 0;
    /// Active G function of group 14: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_14, set_active_g_function_of_group_14: 221, 7 to 0;
    /// Active G function of group 15: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_15, set_active_g_function_of_group_15: 222, 7 to 0;
    /// Active G function of group 16: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_16, set_active_g_function_of_group_16: 223, 7 to 0;
    /// Active G function of group 17: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_17, set_active_g_function_of_group_17: 224, 7 to 0;
    /// Active G function of group 18: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_18, set_active_g_function_of_group_18: 225, 7 to 0;
    /// Active G function of group 19: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_19, set_active_g_function_of_group_19: 226, 7 to 0;
    /// Active G function of group 20: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_20, set_active_g_function_of_group_20: 227, 7 to 0;
    /// Active G function of group 21: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_21, set_active_g_function_of_group_21: 228, 7 to 0;
    /// Active G function of group 22: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_22, set_active_g_function_of_group_22: 229, 7 to 0;
    /// Active G function of group 23: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_23, set_active_g_function_of_group_23: 230, 7 to 0;
    /// Active G function of group 24: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_24, set_active_g_function_of_group_24: 231, 7 to 0;
    /// Active G function of group 25: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_25, set_active_g_function_of_group_25: 232, 7 to 0;
    /// Active G function of group 26: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_26, set_active_g_function_of_group_26: 233, 7 to 0;
    /// Active G function of group 27: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_27, set_active_g_function_of_group_27: 234, 7 to 0;
    /// Active G function of group 28: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_28, set_active_g_function_of_group_28: 235, 7 to 0;
    /// Active G function of group 29: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_29, set_active_g_function_of_group_29: 236, 7 to 0;
    /// Active G function of group 30: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_30, set_active_g_function_of_group_30: 237, 7 to 0;
    /// Active G function of group 31: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_31, set_active_g_function_of_group_31: 238, 7 to 0;
    /// Active G function of group 32: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_32, set_active_g_function_of_group_32: 239, 7 to 0;
    /// Active G function of group 33: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_33, set_active_g_function_of_group_33: 240, 7 to 0;
    /// Active G function of group 34: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_34, set_active_g_function_of_group_34: 241, 7 to 0;
    /// Active G function of group 35: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_35, set_active_g_function_of_group_35: 242, 7 to 0;
    /// Active G function of group 36: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_36, set_active_g_function_of_group_36: 243, 7 to 0;
    /// Active G function of group 37: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_37, set_active_g_function_of_group_37: 244, 7 to 0;
    /// Active G function of group 38: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_38, set_active_g_function_of_group_38: 245, 7 to 0;
    /// Active G function of group 39: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_39, set_active_g_function_of_group_39: 246, 7 to 0;
    /// Active G function of group 40: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_40, set_active_g_function_of_group_40: 247, 7 to 0;
    /// Active G function of group 41: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_41, set_active_g_function_of_group_41: 248, 7 to 0;
    /// Active G function of group 42: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_42, set_active_g_function_of_group_42: 249, 7 to 0;
    /// Active G function of group 43: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_43, set_active_g_function_of_group_43: 250, 7 to 0;
    /// Active G function of group 44: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_44, set_active_g_function_of_group_44: 251, 7 to 0;
    /// Active G function of group 45: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_45, set_active_g_function_of_group_45: 252, 7 to 0;
    /// Active G function of group 46: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_46, set_active_g_function_of_group_46: 253, 7 to 0;
    /// Active G function of group 47: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_47, set_active_g_function_of_group_47: 254, 7 to 0;
    /// Active G function of group 48: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_48, set_active_g_function_of_group_48: 255, 7 to 0;
    /// Active G function of group 49: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_49, set_active_g_function_of_group_49: 256, 7 to 0;
    /// Active G function of group 50: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_50, set_active_g_function_of_group_50: 257, 7 to 0;
    /// Active G function of group 51: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_51, set_active_g_function_of_group_51: 258, 7 to 0;
    /// Active G function of group 52: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_52, set_active_g_function_of_group_52: 259, 7 to 0;
    /// Active G function of group 53: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_53, set_active_g_function_of_group_53: 260, 7 to 0;
    /// Active G function of group 54: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_54, set_active_g_function_of_group_54: 261, 7 to 0;
    /// Active G function of group 55: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_55, set_active_g_function_of_group_55: 262, 7 to 0;
    /// Active G function of group 56: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_56, set_active_g_function_of_group_56: 263, 7 to 0;
    /// Active G function of group 57: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_57, set_active_g_function_of_group_57: 264, 7 to 0;
    /// Active G function of group 58: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_58, set_active_g_function_of_group_58: 265, 7 to 0;
    /// Active G function of group 59: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_59, set_active_g_function_of_group_59: 266, 7 to 0;
    /// Active G function of group 60: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_60, set_active_g_function_of_group_60: 267, 7 to 0;
    /// Active G function of group 61: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_61, set_active_g_function_of_group_61: 268, 7 to 0;
    /// Active G function of group 62: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_62, set_active_g_function_of_group_62: 269, 7 to 0;
    /// Active G function of group 63: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_63, set_active_g_function_of_group_63: 270, 7 to 0;
    /// Active G function of group 64: its index in the group; 0 for a group that is not output (MD22510).
    u8, active_g_function_of_group_64, set_active_g_function_of_group_64: 271, 7 to 0;
    numbers {
        /// Extension of M function 1: the number in its address.
        u16, m_function_1_extension, set_m_function_1_extension: 68;
        /// M function 1.
        u32, m_function_1, set_m_function_1: 70;
        /// Extension of M function 2: the number in its address.
        u16, m_function_2_extension, set_m_function_2_extension: 74;
        /// M function 2.
        u32, m_function_2, set_m_function_2: 76;
        /// Extension of M function 3: the number in its address.
        u16, m_function_3_extension, set_m_function_3_extension: 80;
        /// M function 3.
        u32, m_function_3, set_m_function_3: 82;
        /// Extension of M function 4: the number in its address.
        u16, m_function_4_extension, set_m_function_4_extension: 86;
        /// M function 4.
        u32, m_function_4, set_m_function_4: 88;
        /// Extension of M function 5: the number in its address.
        u16, m_function_5_extension, set_m_function_5_extension: 92;
        /// M function 5.
        u32, m_function_5, set_m_function_5: 94;
        /// Extension of S function 1: the number of the spindle.
        u16, s_function_1_extension, set_s_function_1_extension: 98;
        /// S function 1: the programmed speed.
        f32, s_function_1, set_s_function_1: 100;
        /// Extension of S function 2: the number of the spindle.
        u16, s_function_2_extension, set_s_function_2_extension: 104;
        /// S function 2: the programmed speed.
        f32, s_function_2, set_s_function_2: 106;
        /// Extension of S function 3: the number of the spindle.
        u16, s_function_3_extension, set_s_function_3_extension: 110;
        /// S function 3: the programmed speed.
        f32, s_function_3, set_s_function_3: 112;
        /// Extension of T function 1.
        u16, t_function_1_extension, set_t_function_1_extension: 116;
        /// T function 1: the number of the tool.
        u16, t_function_1, set_t_function_1: 118;
        /// Extension of T function 2.
        u16, t_function_2_extension, set_t_function_2_extension: 120;
        /// T function 2: the number of the tool.
        u16, t_function_2, set_t_function_2: 122;
        /// Extension of T function 3.
        u16, t_function_3_extension, set_t_function_3_extension: 124;
        /// T function 3: the number of the tool.
        u16, t_function_3, set_t_function_3: 126;
        /// Extension of the DL function.
        u16, dl_function_extension, set_dl_function_extension: 134;
        /// DL function: the number of the sum offset.
        f32, dl_function, set_dl_function: 136;
        /// Extension of H function 1: its group.
        u16, h_function_1_extension, set_h_function_1_extension: 140;
        /// H function 1; with MD22110 = 1 a whole number of four bytes.
        f32, h_function_1, set_h_function_1: 142;
        /// Extension of H function 2: its group.
        u16, h_function_2_extension, set_h_function_2_extension: 146;
        /// H function 2; with MD22110 = 1 a whole number of four bytes.
        f32, h_function_2, set_h_function_2: 148;
        /// Extension of H function 3: its group.
        u16, h_function_3_extension, set_h_function_3_extension: 152;
        /// H function 3; with MD22110 = 1 a whole number of four bytes.
        f32, h_function_3, set_h_function_3: 154;
        /// Extension of F function 1: 0 for the path, else the number of the axis.
        u16, f_function_1_extension, set_f_function_1_extension: 158;
        /// F function 1: the programmed feed.
        f32, f_function_1, set_f_function_1: 160;
        /// Extension of F function 2: 0 for the path, else the number of the axis.
        u16, f_function_2_extension, set_f_function_2_extension: 164;
        /// F function 2: the programmed feed.
        f32, f_function_2, set_f_function_2: 166;
        /// Extension of F function 3: 0 for the path, else the number of the axis.
        u16, f_function_3_extension, set_f_function_3_extension: 170;
        /// F function 3: the programmed feed.
        f32, f_function_3, set_f_function_3: 172;
        /// Extension of F function 4: 0 for the path, else the number of the axis.
        u16, f_function_4_extension, set_f_function_4_extension: 176;
        /// F function 4: the programmed feed.
        f32, f_function_4, set_f_function_4: 178;
        /// Extension of F function 5: 0 for the path, else the number of the axis.
        u16, f_function_5_extension, set_f_function_5_extension: 182;
        /// F function 5: the programmed feed.
        f32, f_function_5, set_f_function_5: 184;
        /// Extension of F function 6: 0 for the path, else the number of the axis.
        u16, f_function_6_extension, set_f_function_6_extension: 188;
        /// F function 6: the programmed feed.
        f32, f_function_6, set_f_function_6: 190;
    }
}
