//! Layouts of WGSL structs, to compare their mirrors with.

use super::compose;

/// Names and offsets of a struct's fields, and its size.
pub(crate) fn struct_layout(file: &str, name: &str) -> (Vec<(String, u32)>, u32) {
    let module = naga::front::wgsl::parse_str(&compose(file, &[]).unwrap().text).unwrap();
    let (_, found) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, span } = &found.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|m| (m.name.clone().unwrap(), m.offset)).collect();
    (members, *span)
}

/// Asserts that a Rust struct has the fields of a WGSL struct where that has them, and its size.
macro_rules! assert_layout {
    ($file:literal, $wgsl:literal, $rust:ty, [$($field:ident),* $(,)?]) => {
        let (members, span) = crate::shader::struct_layout($file, $wgsl);
        let mirror = vec![$((stringify!($field).to_owned(), std::mem::offset_of!($rust, $field) as u32)),*];
        assert_eq!(members, mirror);
        assert_eq!(span as usize, size_of::<$rust>());
    };
}

pub(crate) use assert_layout;
