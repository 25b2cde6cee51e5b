//! An MP4 file as a player sees it.

use openh264::decoder::Decoder;
use openh264::formats::YUVSource as _;
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};

/// A video that was decoded.
pub struct Video {
    /// Width and height that the file tells, pixels.
    pub size: (u32, u32),
    /// Start of each frame, seconds.
    pub times: Vec<f64>,
    /// Duration of the file, seconds.
    pub duration: f64,
    /// Whether a player can begin at the frame.
    pub keyframes: Vec<bool>,
    /// The box `colr` of its colors.
    pub colors: Vec<u8>,
    /// Whether the index comes before the frames.
    pub starts_fast: bool,
    /// The frames.
    pub frames: Vec<image::RgbImage>,
}

impl Video {
    /// Reads and decodes all frames.
    pub fn read(bytes: &[u8]) -> Self {
        let at = |name: &[u8; 4]| bytes.windows(4).position(|window| window == name).unwrap();
        let mut demuxer = Mp4FileDemuxer::new();
        demuxer.handle_input(Input { position: 0, data: bytes });
        let tracks = demuxer.tracks().unwrap();
        assert_eq!(tracks.len(), 1);
        let timescale = f64::from(tracks[0].timescale.get());
        let mut video = Self {
            size: (0, 0),
            times: Vec::new(),
            duration: tracks[0].duration as f64 / timescale,
            keyframes: Vec::new(),
            colors: Vec::new(),
            starts_fast: at(b"moov") < at(b"mdat"),
            frames: Vec::new(),
        };
        let mut decoder = Decoder::new().unwrap();
        while let Some(sample) = demuxer.next_sample().unwrap() {
            let mut stream = Vec::new();
            let mut unit = |bytes: &[u8]| stream.extend([&[0, 0, 0, 1], bytes].concat());
            if let Some(entry) = sample.sample_entry {
                let SampleEntry::Avc1(entry) = entry else { panic!("no H.264") };
                video.size = (entry.visual.width.into(), entry.visual.height.into());
                video.colors = entry.unknown_boxes[0].payload.clone();
                entry.avcc_box.sps_list.iter().chain(&entry.avcc_box.pps_list).for_each(|bytes| unit(bytes));
            }
            let mut data = &bytes[sample.data_offset as usize..][..sample.data_size];
            while let Some((length, rest)) = data.split_first_chunk() {
                let (one, rest) = rest.split_at(u32::from_be_bytes(*length) as usize);
                unit(one);
                data = rest;
            }
            video.times.push(sample.timestamp as f64 / timescale);
            video.keyframes.push(sample.keyframe);
            let planes = decoder.decode(&stream).unwrap().expect("a frame");
            let (width, height) = planes.dimensions();
            let stride = planes.strides();
            video.frames.push(image::RgbImage::from_fn(width as u32, height as u32, |x, y| {
                let (x, y) = (x as usize, y as usize);
                let half = |plane: &[u8], stride: usize| f32::from(plane[y / 2 * stride + x / 2]);
                let luma = (f32::from(planes.y()[y * stride.0 + x]) - 16.0) / 219.0;
                let blue = (half(planes.u(), stride.1) - 128.0) / 224.0;
                let red = (half(planes.v(), stride.2) - 128.0) / 224.0;
                // ITU-R BT.709.
                let color = [luma + 1.5748 * red, luma - 0.1873 * blue - 0.4681 * red, luma + 1.8556 * blue];
                image::Rgb(color.map(|channel| (channel * 255.0).round() as u8))
            }));
        }
        video
    }
}
