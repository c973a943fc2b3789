//! Any bytes as a PNG or JPEG file.

#![no_main]

use globefill::Image;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match Image::decode(bytes) {
        Ok(image) => assert!(image.width() > 0 && image.height() > 0),
        Err(error) => {
            let message = error.to_string();
            assert!(
                !message.contains('\n') && message.len() < 1000,
                "{message:?}"
            );
        }
    }
});
