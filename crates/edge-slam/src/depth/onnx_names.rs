//! Takes the names of operators out of an ONNX file.
//!
//! Values and operators may share a name in ONNX, but not in the runtime used here. Operator names only serve people, so
//! leaving them out loses nothing. The file is a protocol buffer: model.graph = 7, graph.node = 1, node.name = 3.

/// The same model without operator names; `None` when the bytes are no protocol buffer.
pub(super) fn without_operator_names(model: &[u8]) -> Option<Vec<u8>> {
    rewrite(model, &[7, 1, 3])
}

/// Copies a message without the field at the end of `path`; messages on the way are rewritten.
fn rewrite(message: &[u8], path: &[u64]) -> Option<Vec<u8>> {
    let (&field, rest) = path.split_first()?;
    let mut output = Vec::with_capacity(message.len());
    let mut input = message;
    while !input.is_empty() {
        let start = input;
        let key = varint(&mut input)?;
        let body = match key & 7 {
            0 => {
                varint(&mut input)?;
                None
            }
            1 => take(&mut input, 8).map(|_| None)?,
            2 => {
                let length = varint(&mut input)?;
                Some(take(&mut input, usize::try_from(length).ok()?)?)
            }
            5 => take(&mut input, 4).map(|_| None)?,
            _ => return None,
        };
        match body.filter(|_| key >> 3 == field) {
            None => output.extend_from_slice(&start[..start.len() - input.len()]),
            Some(_) if rest.is_empty() => {}
            Some(body) => {
                let body = rewrite(body, rest)?;
                put_varint(&mut output, key);
                put_varint(&mut output, body.len() as u64);
                output.extend(body);
            }
        }
    }
    Some(output)
}

fn take<'a>(input: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (head, tail) = input.split_at_checked(count)?;
    *input = tail;
    Some(head)
}

fn varint(input: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let byte = *take(input, 1)?.first()?;
        value |= u64::from(byte & 0x7F) << shift;
        if byte < 0x80 {
            return Some(value);
        }
    }
    None
}

fn put_varint(output: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        output.push((value & 0x7F) as u8 | 0x80);
        value >>= 7;
    }
    output.push((value & 0x7F) as u8);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn only_the_name_goes() {
        // model { ir = 8, graph { node { input "a", name "xy", op "R" }, name "g" } }
        let node = [0x0A, 1, b'a', 0x1A, 2, b'x', b'y', 0x22, 1, b'R'];
        let mut model = vec![0x08, 8, 0x3A, 15, 0x0A, 10];
        model.extend(node);
        model.extend([0x12, 1, b'g']);
        let expected = [
            0x08, 8, 0x3A, 11, 0x0A, 6, 0x0A, 1, b'a', 0x22, 1, b'R', 0x12, 1, b'g',
        ];
        assert_eq!(without_operator_names(&model).unwrap(), expected);
    }

    proptest! {
        #[test]
        fn any_bytes_are_fine(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
            if let Some(shorter) = without_operator_names(&bytes) {
                prop_assert!(shorter.len() <= bytes.len());
            }
        }
    }
}
