//! A video: H.264 in an MP4 file.
//!
//! A video has 16 to 3840 pixels a side, at most 2160 on the shorter one, and even sides: an odd side repeats its last
//! column or row. It is 8 bit 4:2:0 of the Baseline profile, so fine red or blue lines blur. Transparent pixels are
//! black.

use std::io::{Seek as _, SeekFrom, Write as _};
use std::num::NonZeroU32;
use std::path::Path;

use image::RgbaImage;
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Encoder, EncoderConfig, FrameRate, IntraFramePeriod, QpRange, RateControlMode, TransferCharacteristics,
    VuiConfig,
};
use openh264_sys2::{ENCODER_OPTION_TRACE_LEVEL, WELS_LOG_QUIET};
use shiguredo_mp4::bitstream::h264::{
    H264NalUnitType, H264SampleEntryConfig, LengthSize, build_avc1_box_from_annexb, parse_annexb_nal_units,
};
use shiguredo_mp4::boxes::{SampleEntry, UnknownBox};
use shiguredo_mp4::mux::{Mp4FileMuxer, Mp4FileMuxerOptions, Sample, estimate_maximum_moov_box_size};
use shiguredo_mp4::{BoxSize, BoxType, TrackKind};

use super::yuv::Planes;
use crate::picture::Replacement;

/// Pixels that the encoder accepts on each side, and at most on the shorter.
const SIDES: std::ops::RangeInclusive<u32> = 16..=3840;
const SHORTER: u32 = 2160;
/// Quantization of all blocks, 12 (best) to 51. At 18, the PSNR was 38 to 50 dB, including the loss by 4:2:0; larger frames had
/// higher values.
const QUANTIZATION: u8 = 18;
/// Seconds between key frames, from which a player can start.
const SEEK_S: f32 = 2.0;
/// Duration of a frame in ticks of the file's clock. The clock's rate represents the frame rate to a thousandth of a frame per
/// second.
const TICKS: u32 = 1000;

/// A video that is being written, frame by frame, to a temporary file. Dropped unfinished, it leaves no file.
pub(super) struct Mp4 {
    replacement: Replacement,
    encoder: Encoder,
    muxer: Mp4FileMuxer,
    planes: Planes,
    timescale: NonZeroU32,
    /// Bytes in the file.
    position: u64,
    /// Frames in the file.
    count: u32,
}

impl Mp4 {
    /// Begins a video of `expected` frames of `size`. Their index fits in front of them, where a player that streams the file
    /// finds it at once.
    pub(super) fn begin(path: &Path, fps: f32, size: (u32, u32), expected: usize) -> Result<Self, String> {
        let planes = Planes::new(size);
        let (width, height) = planes.size();
        if !SIDES.contains(&width) || !SIDES.contains(&height) || width.min(height) > SHORTER {
            let (least, most) = SIDES.into_inner();
            return Err(format!(
                "an MP4 has {least} to {most} pixels a side, and at most {SHORTER} on the shorter; this one would have {width}x{height}"
            ));
        }
        let mut encoder = Encoder::with_api_config(OpenH264API::from_source(), config(fps)).map_err(text)?;
        silence(&mut encoder);
        let options = Mp4FileMuxerOptions {
            reserved_moov_box_size: estimate_maximum_moov_box_size(&[expected]),
            ..Mp4FileMuxerOptions::default()
        };
        let muxer = Mp4FileMuxer::with_options(options).map_err(text)?;
        let timescale = NonZeroU32::new((fps * TICKS as f32).round() as u32).unwrap_or(NonZeroU32::MIN);
        let mut replacement = Replacement::begin(path).map_err(text)?;
        let head = muxer.initial_boxes_bytes();
        replacement.file.write_all(head).map_err(text)?;
        let position = head.len() as u64;
        Ok(Self { replacement, encoder, muxer, planes, timescale, position, count: 0 })
    }

    /// Adds a frame.
    pub(super) fn add(&mut self, frame: &RgbaImage) -> Result<(), String> {
        self.planes.fill(frame);
        let stream = self.encoder.encode(&self.planes.slices()).map_err(text)?.to_vec();
        let mut data = Vec::with_capacity(stream.len());
        let mut keyframe = false;
        for unit in parse_annexb_nal_units(&stream).map_err(text)? {
            // These two are in the sample entry.
            if matches!(unit.nal_unit_type, H264NalUnitType::Sps | H264NalUnitType::Pps) {
                continue;
            }
            keyframe |= unit.nal_unit_type == H264NalUnitType::IdrSlice;
            data.extend((unit.data.len() as u32).to_be_bytes());
            data.extend_from_slice(unit.data);
        }
        if data.is_empty() {
            return Err("the encoder has left out a frame".to_owned());
        }
        let sample_entry = if self.count == 0 { Some(sample_entry(&stream)?) } else { None };
        self.replacement.file.write_all(&data).map_err(text)?;
        self.muxer
            .append_sample(&Sample {
                track_kind: TrackKind::Video,
                sample_entry,
                keyframe,
                timescale: self.timescale,
                duration: TICKS,
                composition_time_offset: None,
                data_offset: self.position,
                data_size: data.len(),
            })
            .map_err(text)?;
        self.position += data.len() as u64;
        self.count += 1;
        Ok(())
    }

    /// Writes the index, and gives the file its name.
    pub(super) fn finish(mut self) -> Result<(), String> {
        for (offset, bytes) in self.muxer.finalize().map_err(text)?.offset_and_bytes_pairs() {
            self.replacement.file.seek(SeekFrom::Start(offset)).map_err(text)?;
            self.replacement.file.write_all(bytes).map_err(text)?;
        }
        self.replacement.finish().map_err(text)
    }
}

/// Every block has the same quantization, so that quality does not depend on motion, and no frame is skipped.
fn config(fps: f32) -> EncoderConfig {
    // Luma and chroma follow BT.709, but a display-encoded frame has the transfer function of sRGB.
    let colors = VuiConfig::bt709().transfer_characteristics(TransferCharacteristics::Srgb);
    EncoderConfig::new()
        .rate_control_mode(RateControlMode::Quality)
        .bitrate(BitRate::from_bps(50_000_000))
        .qp(QpRange::new(QUANTIZATION, QUANTIZATION))
        .skip_frames(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .scene_change_detect(false)
        .max_frame_rate(FrameRate::from_hz(fps))
        .intra_frame_period(IntraFramePeriod::from_num_frames((fps * SEEK_S).ceil().max(1.0) as u32))
        .num_threads(1)
        .vui(colors)
}

/// How the frames are to be decoded, from the stream of the first.
fn sample_entry(stream: &[u8]) -> Result<SampleEntry, String> {
    let config = H264SampleEntryConfig { length_size: LengthSize::FourBytes };
    let mut entry = build_avc1_box_from_annexb(stream, &config).map_err(text)?;
    // Color for players that do not parse the stream: the codes are those of `config`, and the last byte means limited range.
    let colors: Vec<u8> = [&b"nclx"[..], &[0, 1, 0, 13, 0, 1, 0]].concat();
    let box_type = BoxType::Normal(*b"colr");
    let box_size = BoxSize::with_payload_size(box_type, colors.len() as u64);
    entry.unknown_boxes.push(UnknownBox { box_type, box_size, payload: colors });
    Ok(SampleEntry::Avc1(entry))
}

/// Keeps the encoder from writing to stderr. It warns about a bitrate that it cannot hold, which does not matter here.
fn silence(encoder: &mut Encoder) {
    let mut level = WELS_LOG_QUIET;
    // SAFETY: the encoder lives, reads one integer during the call, and takes this option also before its first frame.
    unsafe { encoder.raw_api().set_option(ENCODER_OPTION_TRACE_LEVEL, (&raw mut level).cast()) };
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_video_that_is_not_finished_leaves_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mp4");
        let count = || std::fs::read_dir(folder.path()).unwrap().count();
        let mut video = Mp4::begin(&path, 25.0, (32, 16), 2).unwrap();
        video.add(&RgbaImage::new(32, 16)).unwrap();
        assert!(!path.exists() && count() == 1, "it is written as it is drawn, under another name");
        drop(video);
        assert_eq!(count(), 0);
    }

    #[test]
    fn sizes_have_limits() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.mp4");
        for (size, fits) in
            [((15, 16), true), ((14, 16), false), ((2160, 3840), true), ((3841, 16), false), ((2162, 2162), false)]
        {
            assert_eq!(Mp4::begin(&path, 25.0, size, 1).is_ok(), fits, "{size:?}");
        }
    }
}
