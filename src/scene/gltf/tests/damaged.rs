//! Damaged files are refused, or loaded with what is left of them.

use super::*;
use crate::damaged;

/// A caught panic would be a bug of the loader, not an answer.
pub(super) fn load_or_refuse(bytes: &[u8]) {
    if let Err(LoadError { problem, .. }) = load_bytes("damaged", bytes) {
        assert!(!matches!(*problem, Problem::Refused { .. }), "{problem}");
    }
}

fn textured() -> Builder {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::new(3, 2).write_to(&mut png, image::ImageFormat::Png).unwrap();
    let mut builder = Builder::square();
    builder.image("normalTexture", &png.into_inner());
    builder
}

/// Models that are shipped, each with several extensions.
const SHIPPED: [&[u8]; 3] = [
    include_bytes!("../../../../assets/variants.glb"),
    include_bytes!("../../../../assets/many-lights.glb"),
    include_bytes!("../../../../assets/iridescence.glb"),
];

#[test]
fn damaged_binaries_cause_no_panic() {
    let (square, textured) = (Builder::square().glb(), textured().glb());
    damaged::each(300, &[&square, &textured, SHIPPED[0], SHIPPED[1], SHIPPED[2]], load_or_refuse);
}

#[test]
fn damaged_texts_cause_no_panic() {
    let text = |builder: &Builder| {
        let mut json = builder.json.clone();
        let numbers: Vec<String> = builder.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
        json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream,{}", numbers.concat()));
        json.to_string().into_bytes()
    };
    let (square, textured) = (text(&Builder::square()), text(&textured()));
    load_bytes("whole", &square).unwrap();
    let shipped = SHIPPED.map(|glb| {
        let length = u32::from_le_bytes(*glb[12..].first_chunk().unwrap()) as usize;
        glb[20..20 + length].to_vec()
    });
    damaged::each(300, &[&square, &textured, &shipped[0], &shipped[1], &shipped[2]], load_or_refuse);
}
