//! Which resources are bound for which stages.
//!
//! A stage that reads a resource which nothing binds for it would read 0 or crash the driver. [`StageRole::binds`] says what is
//! bound; the contract check refuses everything else at its line, and `pipeline` refuses a module that slipped through.

/// The purpose that a stage is run for. It decides which resources are bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StageRole {
    /// A stage that draws the model: the picture, debug modes, passes with `draw=model`.
    Model,
    /// `paths.frag`: draws the model and traces rays through it.
    Paths,
    /// A stage of a pass with `draw=quads`.
    Quads,
    /// A stage that covers an image: the background, the tone map, the accumulation, passes.
    Screen,
    /// A compute pass.
    Compute,
    /// `deform.comp`: moves vertices.
    Deform,
    /// A compute stage that bakes light or BRDF tables.
    Bake,
    /// A compute stage of `specula brdf` and of the inspector.
    Measure,
}

/// A resource of the contract, or a group of resources that are bound together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Resource {
    /// The block `Params`.
    Params,
    /// The block `Frame`.
    Frame,
    /// The lights.
    Lights,
    /// The block `Material` and its textures.
    Material,
    /// The push constants `Draw`.
    Draw,
    /// The environment's cube map, its prefiltered levels and its irradiance.
    Environment,
    /// The BRDF's tables: albedo, linearly transformed cosines, measured data.
    Tables,
    /// The scene that rays are traced through.
    Scene,
    /// Images, textures, buffers and blocks that a stage declares by name.
    Pass,
    /// The parameters, inputs and outputs of a bake.
    Task,
    /// The instances whose vertices joints or morph targets move.
    Deformations,
}

impl StageRole {
    /// The role of a compute stage that no pass declares, by its path.
    pub fn of_compute(path: &str) -> Self {
        match path {
            "deform.comp" => Self::Deform,
            path if path.starts_with("measure/") => Self::Measure,
            _ => Self::Bake,
        }
    }

    /// Whether the resource is bound with its values wherever such a stage runs.
    pub fn binds(self, resource: Resource) -> bool {
        let is_task = matches!(self, Self::Bake | Self::Measure);
        let has_frame = !is_task && self != Self::Deform;
        match resource {
            Resource::Params => true,
            Resource::Frame | Resource::Lights | Resource::Environment | Resource::Pass => has_frame,
            Resource::Tables => has_frame || self == Self::Measure,
            Resource::Material | Resource::Draw => matches!(self, Self::Model | Self::Paths),
            Resource::Scene => self == Self::Paths,
            Resource::Task => is_task,
            Resource::Deformations => self == Self::Deform,
        }
    }

    /// The stage in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Model => "a stage that draws the model",
            Self::Paths => "the path tracer",
            Self::Quads => "a pass that draws quads",
            Self::Screen => "a stage that covers an image",
            Self::Compute => "a compute pass",
            Self::Deform => "the stage that moves vertices",
            Self::Bake => "a bake",
            Self::Measure => "a measurement of the BRDF",
        }
    }
}

impl Resource {
    /// Every resource, in the order of the documentation.
    pub const ALL: [Self; 11] = [
        Self::Params,
        Self::Frame,
        Self::Lights,
        Self::Material,
        Self::Draw,
        Self::Environment,
        Self::Tables,
        Self::Scene,
        Self::Pass,
        Self::Task,
        Self::Deformations,
    ];

    /// The resource in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Params => "parameters",
            Self::Frame => "frame constants",
            Self::Lights => "lights",
            Self::Material => "material",
            Self::Draw => "draw constants",
            Self::Environment => "environment",
            Self::Tables => "BRDF tables",
            Self::Scene => "scene to trace",
            Self::Pass => "images, textures, buffers or blocks of a pass",
            Self::Task => "task of a bake",
            Self::Deformations => "moved instances",
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write as _;

    use super::*;

    impl StageRole {
        /// Every role, in the order of the documentation.
        const ALL: [Self; 8] = [
            Self::Model,
            Self::Paths,
            Self::Quads,
            Self::Screen,
            Self::Compute,
            Self::Deform,
            Self::Bake,
            Self::Measure,
        ];

        /// The stage as the head of a column in the documentation.
        fn column(self) -> &'static str {
            match self {
                Self::Model => "model",
                Self::Paths => "paths.frag",
                Self::Quads => "draw=quads",
                Self::Screen => "full screen",
                Self::Compute => ".comp pass",
                Self::Deform => "deform.comp",
                Self::Bake => "ibl/",
                Self::Measure => "measure/",
            }
        }
    }

    impl Resource {
        /// The resource as the head of a row in the documentation.
        fn row(self) -> &'static str {
            match self {
                Self::Params => "members of `Params` (`user/params.glsl`)",
                Self::Frame => "`frame.*`",
                Self::Lights => "`lights[]`",
                Self::Material => "`material.*` and its textures",
                Self::Draw => "`draw.*`",
                Self::Environment => "the environment's images (`lighting/environment_map.glsl`)",
                Self::Tables => "BRDF tables, measured BRDF (`brdf/energy/dfg.glsl`, `brdf/measured.glsl`)",
                Self::Scene => "the traced scene (`paths/scene.glsl`)",
                Self::Pass => "images of passes, `//@texture`, buffers, blocks of one's own",
                Self::Task => "`task.*`",
                Self::Deformations => "`BINDING_DEFORMATIONS`",
            }
        }
    }

    /// The table of resources and stages, in Markdown: part of `shaders/README.md`.
    fn table() -> String {
        let mut out = String::from("| read in |");
        let mut rule = String::from("|---|");
        for role in StageRole::ALL {
            // A `String` takes everything.
            let _ = write!(out, " {} |", role.column());
            rule.push_str("---|");
        }
        let constants = std::iter::repeat_n(" works |", StageRole::ALL.len()).collect::<String>();
        let _ = write!(out, "\n{rule}\n| constants with `//@ui` |{constants}\n");
        for resource in Resource::ALL {
            let _ = write!(out, "| {} |", resource.row());
            for role in StageRole::ALL {
                out.push_str(if role.binds(resource) { " works |" } else { " refused |" });
            }
            out.push('\n');
        }
        out
    }

    #[test]
    fn the_table_of_resources_is_current() {
        let page = include_str!("../../shaders/README.md");
        let table = table();
        assert!(page.contains(&table), "shaders/README.md lacks this table:\n{table}");
    }

    #[test]
    fn every_resource_is_bound_somewhere() {
        for resource in Resource::ALL {
            assert!(StageRole::ALL.iter().any(|role| role.binds(resource)), "{resource:?}");
        }
    }
}
