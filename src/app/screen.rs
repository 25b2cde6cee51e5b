//! The window on the device: its swapchain, the views that draw pictures, and what is drawn in and between frames. A session without a window
//! has an image in place of the swapchain (`target.rs`), and all else alike. The screen draws requests of plain values (`request`, `between`) and gives their results. It knows neither state nor engine nor panels.

mod background;
mod between;
mod between_request;
mod cells;
mod difference_pair;
mod error_map;
mod frame;
mod gallery;
mod inspector;
mod loops;
mod number;
mod outline;
mod parts;
mod pictures;
mod pixel;
mod pointed;
mod preview;
mod preview_view;
mod reference;
mod reference_view;
mod refine;
mod request;
mod sets;
mod target;
mod texture;
mod thumbnail;
mod ui;
mod window_copy;

use std::sync::Arc;

use glam::Vec2;
use winit::window::Window;

use super::state::grid::PictureRect;
use crate::gpu::{Buffer, Frames, Gpu, GpuError, SetLayouts, Swapchain, UiRenderer};
use crate::render::tools::Outline;
use crate::render::{BoundFrame, PixelAt, View};
use crate::scene::{CameraView, view_of};
use crate::session::Session;
use between::Between;
pub(super) use between::POLL;
pub(super) use between_request::{BetweenRequest, Build, Inspected, InspectorRequest};
use cells::{Cell, Cells};
use difference_pair::ErrorMap;
pub(super) use error_map::Measurement;
pub(super) use frame::Beginning;
pub(super) use loops::Ended;
use loops::LoopChecks;
pub(super) use parts::Part;
use parts::Parts;
pub(super) use pixel::PixelUnderMouse;
pub(super) use preview_view::ENLARGE;
use preview_view::Preview;
pub(super) use reference_view::Reference;
use reference_view::ReferenceView;
use request::FRAMES_IN_FLIGHT;
pub(super) use request::{FrameRequest, OutlineRequest, TextureDraw};
pub(super) use sets::RestingPicture;
use target::Target;
use texture::ShownTexture;
use window_copy::WindowCopy;

/// The window on the device. Fields drop in order, so renderers go before the target.
pub(super) struct Screen {
    ui: UiRenderer,
    pub(super) between: Between,
    pub(super) view: View,
    /// The parts of a picture that is drawn between frames.
    parts: Parts,
    /// Draws previews, while there are any.
    preview: Option<Preview>,
    frames: Frames,
    gpu: Arc<Gpu>,
    layouts: Arc<SetLayouts>,
    target: Target,
    /// Textures of egui to upload, and those to free because no later frame uses them.
    textures: egui::TexturesDelta,
    /// The last frame for which targets could be allocated. It is drawn again while memory is short.
    last: Option<BoundFrame>,
    /// The out-of-memory error of the current frame.
    shortage: Option<GpuError>,
    loops: LoopChecks,
    /// The picture that the user compares with, while there is one.
    reference: Option<ReferenceView>,
    error_map: ErrorMap,
    window_copy: Option<WindowCopy>,
    /// The targets of the selection's outline, while there is a selection.
    outline: Option<Outline>,
    texture: ShownTexture,
    /// The newest value under the mouse, and whether it is the reference's.
    pixel: Option<(PixelAt, bool)>,
    /// The mouse, in pixels of the window, while it is over the picture.
    pub(super) pointer: Option<Vec2>,
    /// The part of the window that shows the selected mode.
    pub(super) rect: PictureRect,
    /// The part that shows all modes of the grid.
    pub(super) whole: PictureRect,
    /// The modes of the grid beside the selected one.
    cells: Cells,
    /// Whether another frame must follow at once.
    redraws: bool,
}

impl Screen {
    /// The screen of a window.
    pub(super) fn of_window(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, window: &Window) -> Result<Self, GpuError> {
        Self::new(gpu, layouts, |_| Target::window(gpu, window))
    }

    /// The screen of a session without a window, whose picture has this size.
    pub(super) fn unseen(gpu: &Arc<Gpu>, layouts: &Arc<SetLayouts>, size: (u32, u32)) -> Result<Self, GpuError> {
        let mut screen = Self::new(gpu, layouts, |view| Target::image(view, size))?;
        screen.whole = PictureRect { at: (0, 0), size };
        Ok(screen)
    }

    fn new(
        gpu: &Arc<Gpu>,
        layouts: &Arc<SetLayouts>,
        target: impl FnOnce(&View) -> Result<Target, GpuError>,
    ) -> Result<Self, GpuError> {
        // One more slot, for parts of the picture.
        let view = View::new(gpu, layouts, FRAMES_IN_FLIGHT + 1)?;
        let target = target(&view)?;
        Ok(Self {
            ui: UiRenderer::new(gpu, Swapchain::FORMAT, FRAMES_IN_FLIGHT)?,
            between: Between::new(gpu, layouts)?,
            view,
            parts: Parts::new(gpu)?,
            preview: None,
            frames: Frames::new(gpu, FRAMES_IN_FLIGHT)?,
            gpu: gpu.clone(),
            layouts: layouts.clone(),
            target,
            textures: egui::TexturesDelta::default(),
            last: None,
            shortage: None,
            loops: LoopChecks::default(),
            reference: None,
            error_map: ErrorMap::default(),
            window_copy: None,
            outline: None,
            texture: ShownTexture::default(),
            pixel: None,
            pointer: None,
            rect: PictureRect::default(),
            whole: PictureRect::default(),
            cells: Cells::default(),
            redraws: false,
        })
    }

    pub(super) fn resized(&mut self) {
        self.target.outdate();
    }

    /// The size of the images that frames are drawn to, once there are any.
    pub(super) fn extent(&self) -> Option<(u32, u32)> {
        self.target.extent()
    }

    /// The camera of the last frame.
    pub(super) fn camera_view(&self) -> Option<CameraView> {
        self.last.as_ref().map(|frame| frame.state.camera)
    }

    /// The camera of the next frame, which one event after another moves. That of the last frame knows none of them.
    pub(super) fn camera_now(&self, session: &Session) -> Option<CameraView> {
        let model = session.placed_model().unwrap_or_default();
        self.camera_view().map(|last| view_of(&model, &session.settings.camera, last.aspect))
    }

    /// The frame that was accepted last.
    pub(super) fn last_frame(&self) -> Option<&BoundFrame> {
        self.last.as_ref()
    }

    /// The frames, for their times.
    pub(super) fn frames(&self) -> &Frames {
        &self.frames
    }

    /// Recreates the swapchain if it does not fit a window of this size. Returns whether there are images to draw to.
    pub(super) fn resize(&mut self, size: (u32, u32)) -> Result<bool, GpuError> {
        self.target.fit(&self.gpu, size)
    }

    /// Whether a picture is drawn beside the newest one for a comparison.
    pub(super) fn has_reference(&self) -> bool {
        self.reference.is_some()
    }

    /// Reads the values that finished frames have left.
    pub(super) fn read_finished(&mut self) {
        self.read_pixel();
        self.read_range_sample();
    }

    /// The frame to draw: `prepared`, or the last one if it could not be prepared.
    pub(super) fn accept(
        &mut self,
        prepared: Result<Option<BoundFrame>, GpuError>,
    ) -> Result<Option<BoundFrame>, GpuError> {
        if let Some(frame) = self.survive(prepared)? {
            self.last = frame;
        }
        Ok(self.last.clone())
    }

    /// Sets the part of the window that shows the selected mode, and drops all cells of the grid but these.
    pub(super) fn arrange(&mut self, selected: PictureRect, others: &[(String, PictureRect)]) {
        self.rect = selected;
        self.cells.arrange(others);
    }

    /// The cell of a mode beside the selected one, with an image of its size.
    pub(super) fn cell(&mut self, mode: &str, rect: PictureRect) -> Result<&mut Cell, GpuError> {
        self.cells.cell((&self.gpu, &self.layouts), mode, rect)
    }

    /// Drops all cells.
    pub(super) fn end_cells(&mut self) {
        self.cells.0.clear();
    }

    /// Whether a copy of the window is on its way.
    pub(super) fn copies_window(&self) -> bool {
        self.window_copy.is_some()
    }

    /// The pixels of the window and its size, once the frame that copied them has finished.
    pub(super) fn take_window_copy(&mut self) -> Option<(Arc<Buffer>, (u32, u32))> {
        let copy = self.window_copy.take_if(|copy| self.frames.is_finished(copy.slot))?;
        Some((copy.pixels, copy.size))
    }

    /// Drops all that a frame for which memory was short may have left incomplete.
    pub(super) fn forget_frame(&mut self) {
        self.view.forget();
        (self.reference, self.outline, self.preview) = (None, None, None);
        self.texture.forget();
        self.cells.0.clear();
    }

    /// The out-of-memory error of the frame that ends.
    pub(super) fn take_shortage(&mut self) -> Option<GpuError> {
        self.shortage.take()
    }

    /// Turns an out-of-memory error into `None`, and keeps it for the end of the frame.
    pub(super) fn survive<T>(&mut self, result: Result<T, GpuError>) -> Result<Option<T>, GpuError> {
        match result {
            Err(error) if error.is_shortage() => {
                self.shortage = Some(error);
                Ok(None)
            }
            result => result.map(Some),
        }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.textures.clear();
    }
}
