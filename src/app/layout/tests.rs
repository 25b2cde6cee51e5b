//! The arrangement in windows of different sizes.

use egui_tiles::Tiles;

use super::*;

/// Lays the tiles out in a window of this size, and returns the picture.
fn shown(layout: &mut Layout, egui: &egui::Context, size: Vec2) -> Rect {
    let input = egui::RawInput { screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)), ..Default::default() };
    let mut picture = Rect::NOTHING;
    let _ = egui.run_ui(input, |ui| picture = layout.show(ui, &mut |_, _| {}));
    picture
}

#[test]
fn panels_keep_their_width_and_the_picture_takes_the_rest() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let widths = [1280.0, 2560.0, 900.0, 1280.0].map(|width| {
        let picture = shown(&mut layout, &egui, Vec2::new(width, 720.0));
        (picture.min.x, width - picture.max.x)
    });
    for (left, right) in widths {
        assert!((left - widths[0].0).abs() < 1.5 && (right - widths[0].1).abs() < 1.5, "{widths:?}");
    }
    assert!(widths[0].0 > 150.0 && widths[0].1 > 250.0, "{widths:?}");
    // A narrow window hides the panels on the left, and a wide one shows them again with their width.
    let narrow = shown(&mut layout, &egui, Vec2::new(640.0, 480.0));
    assert!(narrow.min.x == 0.0 && narrow.width() > 250.0, "{narrow:?}");
    let wide = shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
    assert!((wide.min.x - widths[0].0).abs() < 1.5, "{wide:?}, {widths:?}");
    // Even a tiny window shows the picture.
    assert!(shown(&mut layout, &egui, Vec2::new(300.0, 200.0)).width() > 100.0);
}

#[test]
fn every_panel_closes_and_opens_again() {
    for preset in Preset::ALL {
        let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(preset));
        let size = Vec2::new(1280.0, 720.0);
        let first = shown(&mut layout, &egui, size);
        layout.is_changed = false;
        for panel in Panel::groups().concat() {
            layout.close(panel);
            layout.is_changed = false;
            shown(&mut layout, &egui, size);
            assert!(!layout.is_open(panel));
        }
        assert!(shown(&mut layout, &egui, size).width() > 1270.0, "a column without panels is left");
        for panel in Panel::groups().concat() {
            layout.open(panel);
            layout.is_changed = false;
            shown(&mut layout, &egui, size);
            assert!(layout.is_open(panel), "{panel:?}");
            let mut seen = false;
            let input =
                egui::RawInput { screen_rect: Some(Rect::from_min_size(egui::Pos2::ZERO, size)), ..Default::default() };
            let _ = egui.run_ui(input, |ui| {
                layout.show(ui, &mut |_, shown| seen |= shown == panel);
            });
            assert!(seen, "{panel:?} is open behind another tab");
        }
        assert!(shown(&mut layout, &egui, size).width() > 0.5 * first.width());
    }
}

#[test]
fn panels_that_a_small_window_shrinks_grow_again() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let [first, small, last] = [1280.0, 400.0, 1280.0].map(|width| {
        let picture = shown(&mut layout, &egui, Vec2::new(width, 720.0));
        width - picture.max.x
    });
    assert!(small < first - 10.0 && (last - first).abs() < 1.5, "{first}, {small}, {last}");
}

#[test]
fn a_panel_that_a_narrow_window_hides_can_be_opened() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let size = Vec2::new(640.0, 480.0);
    let left_of_picture = shown(&mut layout, &egui, size).min.x;
    layout.open(Panel::MODES);
    layout.is_changed = false;
    let picture = shown(&mut layout, &egui, size);
    assert!(left_of_picture == 0.0 && picture.min.x > 100.0 && picture.max.x > 638.0, "{picture:?}");
}

#[test]
fn a_preset_keeps_the_arrangement_that_the_user_made() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
    layout.close(Panel("Lights"));
    for preset in [Preset::Look, Preset::Debug] {
        layout.arrange(preset);
        assert!(layout.is_open(Panel("Lights")) && layout.has_own());
        // A change of the preset keeps the own arrangement.
        layout.close(Panel::OUTPUT);
    }
    layout.arrange_own();
    assert!(!layout.is_open(Panel("Lights")) && layout.is_open(Panel::MODES) && !layout.has_own());
}

#[test]
fn a_reset_shows_the_preset_that_was_chosen_last() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let size = Vec2::new(1280.0, 720.0);
    shown(&mut layout, &egui, size);
    layout.close(Panel::MODES);
    layout.reset();
    assert!(layout.is_open(Panel::MODES) && layout.has_own(), "the first preset, and a way back");
    layout.arrange(Preset::Compare);
    layout.close(Panel::TIMELINE);
    layout.reset();
    assert!(layout.is_open(Panel::TIMELINE));
    // A reset of a temporary arrangement leaves it temporary.
    layout.arrange_temporarily(Preset::Toy);
    layout.reset();
    layout.arrange_as_before();
    assert!(layout.is_open(Panel::TIMELINE));
}

/// The panels that the user opens beside those of presets, and changes of the arrangement for single files, outlive a change between
/// files and trees.
#[test]
fn the_arrangement_for_a_single_file_is_the_users() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let show = |layout: &mut Layout| {
        layout.is_changed = false;
        shown(layout, &egui, Vec2::new(1280.0, 720.0))
    };
    show(&mut layout);
    layout.open(Panel::SOURCE);
    layout.arrange_temporarily(Preset::Toy);
    show(&mut layout);
    assert!(layout.is_open(Panel::SOURCE) && layout.is_open(Panel::PASSES) && !layout.is_open(Panel("Camera")));
    layout.close(Panel::TIMELINE);
    layout.arrange_as_before();
    show(&mut layout);
    assert!(layout.is_open(Panel::SOURCE) && layout.is_open(Panel::TIMELINE) && layout.is_open(Panel("Camera")));
    layout.close(Panel::SOURCE);
    layout.arrange_temporarily(Preset::Toy);
    show(&mut layout);
    assert!(layout.is_open(Panel::SOURCE) && !layout.is_open(Panel::TIMELINE), "as it was left");
    layout.reset();
    layout.arrange_as_before();
    assert!(!layout.is_open(Panel::SOURCE));
    layout.arrange_temporarily(Preset::Toy);
    assert!(!layout.is_open(Panel::SOURCE) && layout.is_open(Panel::TIMELINE), "as it was at first");
    show(&mut layout);
    layout.close(Panel::TIMELINE);
    layout.arrange_as_before();
    show(&mut layout);
    layout.open(Panel::SOURCE);
    layout.arrange_temporarily(Preset::Toy);
    show(&mut layout);
    assert!(!layout.is_open(Panel::SOURCE) && !layout.is_open(Panel::TIMELINE), "the user's own, without Source");
}

#[test]
fn a_panel_on_the_picture_moves_beside_it() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    let size = Vec2::new(1280.0, 720.0);
    shown(&mut layout, &egui, size);
    let tiles = &mut layout.tree.tiles;
    let (picture, lights) = (tiles.find_pane(&Panel::VIEWPORT).unwrap(), tiles.find_pane(&Panel("Lights")).unwrap());
    let (tabs, root) = (tiles.parent_of(lights).unwrap(), tiles.parent_of(picture).unwrap());
    let container = |tiles: &mut Tiles<Panel>, id, change: &dyn Fn(&mut Container)| match tiles.get_mut(id) {
        Some(Tile::Container(container)) => change(container),
        _ => panic!("no container"),
    };
    container(tiles, tabs, &|tabs| _ = tabs.remove_child(lights));
    // As a drop on the middle of the picture leaves it.
    let new = tiles.insert_tab_tile(vec![picture, lights]);
    container(tiles, root, &|root| _ = root.replace_child(picture, new));
    repair(&mut layout.tree);
    layout.fit.invalidate();
    let picture = shown(&mut layout, &egui, size);
    assert!(picture.width() > 200.0 && layout.is_open(Panel("Lights")), "{picture:?}");
    assert!(
        fit::path_to_picture(&layout.tree.tiles)
            .into_iter()
            .all(|[parent, _]| { !matches!(layout.tree.tiles.get_container(parent), Some(Container::Tabs(_))) })
    );
}

#[test]
fn handles_lie_only_between_the_picture_and_panels() {
    let area = Rect::from_min_max(egui::pos2(0.0, 30.0), egui::pos2(1000.0, 700.0));
    let picture = area.with_min_x(240.0);
    let free = fit::without_handles(picture, area, 10.0);
    assert_eq!(free, picture.with_min_x(250.0));
}

#[test]
fn the_active_tab_shows_its_whole_title() {
    let (egui, mut layout) = (egui::Context::default(), Layout::of_preset(Preset::Debug));
    crate::app::widgets::theme::apply(&egui);
    for panel in Panel::groups().concat() {
        layout.open(panel);
        // The second frame has the widths of the first.
        for _ in 0..2 {
            layout.is_changed = false;
            shown(&mut layout, &egui, Vec2::new(1280.0, 720.0));
        }
        let tiles = &layout.tree.tiles;
        let pane = tiles.find_pane(&panel).unwrap();
        let tile = tiles.rect(tiles.parent_of(pane).unwrap()).unwrap();
        let tab = egui.read_response(pane.egui_id(layout.tree.id())).unwrap().rect;
        let font = egui::TextStyle::Button.resolve(&egui.global_style());
        let title = panel.0.to_owned();
        let width = egui.fonts_mut(|fonts| fonts.layout_no_wrap(title, font, egui::Color32::WHITE).size().x);
        assert!(tab.width() >= width && tile.x_range().contains(tab.max.x), "{panel:?}: {tab:?} in {tile:?}");
    }
}
