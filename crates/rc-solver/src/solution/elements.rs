//! Elements of all ranks, one after the other.

use rc_comm::{Packed, Ranks};
use rc_core::DVec2;

use crate::descent::contact_element::ContactElement;

/// Number of elements in a message.
const AT_ONCE: usize = 1 << 16;

/// Hands the elements of all ranks to `take` on the first rank.
///
/// The order is that of ranks. All ranks call this together. After an error, elements of other ranks are dropped.
pub(super) fn each_of_ranks<E>(
    mut own: impl Iterator<Item = ContactElement>,
    ranks: &Ranks,
    mut take: impl FnMut(ContactElement) -> Result<(), E>,
) -> Result<(), E> {
    if ranks.rank() == 0 {
        let mut taken = own.try_for_each(&mut take);
        for other in 1..ranks.size() {
            // The last message is the one that is not full.
            loop {
                let elements = <[f64; 4]>::unpack_all(&ranks.exchange(Vec::new(), &[other]).concat());
                if taken.is_ok() {
                    taken = elements.iter().try_for_each(|&[x, y, side, pressure]| {
                        take(ContactElement { centre: DVec2::new(x, y), side, pressure })
                    });
                }
                if elements.len() < AT_ONCE {
                    break;
                }
            }
        }
        return taken;
    }
    let mut numbers = own.map(|ContactElement { centre, side, pressure }| [centre.x, centre.y, side, pressure]);
    loop {
        let (elements, mut bytes): (Vec<_>, _) = (numbers.by_ref().take(AT_ONCE).collect(), Vec::new());
        Packed::pack(&elements, &mut bytes);
        let _ = ranks.exchange(vec![(0, bytes)], &[]);
        if elements.len() < AT_ONCE {
            return Ok(());
        }
    }
}
