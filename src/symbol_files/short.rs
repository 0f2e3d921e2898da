//! Names for tools that allow neither dots nor long names.

use std::collections::BTreeSet;

/// Names in one space of names, compared without case; a name that is taken already gets a number.
pub(super) struct Names {
    longest: usize,
    taken: BTreeSet<String>,
    /// How many names were shortened, or got a number.
    pub(super) changed: usize,
}

impl Names {
    /// Names with at most so many characters.
    pub(super) const fn up_to(longest: usize) -> Self {
        Self { longest, taken: BTreeSet::new(), changed: 0 }
    }

    /// The name for a name of the machine: letters, digits, and underscores, at most of the length.
    pub(super) fn name(&mut self, full: &str) -> String {
        let safe: String = full.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
        let mut name = shortened(&safe, self.longest);
        let mut count = 1;
        while !self.taken.insert(name.to_uppercase()) {
            count += 1;
            let end = format!("_{count}");
            name = shortened(&safe, self.longest - end.len()) + &end;
        }
        if name != safe {
            self.changed += 1;
        }
        name
    }
}

/// The longest words lose letters at their ends until the name fits, so that each word stays readable.
fn shortened(name: &str, longest: usize) -> String {
    let mut words: Vec<&str> = name.split('_').collect();
    let length = |words: &[&str]| words.iter().map(|word| word.len()).sum::<usize>() + words.len() - 1;
    while length(&words) > longest {
        // The last of the longest words: the first words tell what a signal is about.
        let Some(word) = words.iter_mut().max_by_key(|word| word.len()).filter(|word| word.len() > 1) else {
            return name[..longest].to_owned();
        };
        *word = &word[..word.len() - 1];
    }
    words.join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_name_keeps_the_beginnings_of_its_words() {
        assert_eq!(shortened("traversing_key_plus", 24), "traversing_key_plus");
        // 29 characters: five letters of the words with the most letters are left out, from the last of them.
        assert_eq!(shortened("start_gantry_synchronization", 24), "start_gantry_synchroniza");
        assert_eq!(shortened("a_b_c_d_e_f_g_h_i_j_k_l_m_n", 24), "a_b_c_d_e_f_g_h_i_j_k_l_");
    }

    #[test]
    fn a_name_that_is_taken_gets_a_number() {
        let mut names = Names::up_to(8);
        assert_eq!(names.name("X.on"), "X_on");
        assert_eq!(names.name("x.ON"), "x_ON_2");
        assert_eq!(names.changed, 1);
    }
}
