//! The transform of a node relative to its parent, in parts that animations replace.

use glam::{DMat4, DQuat, DVec3};

/// Translation, rotation and scale of a node, applied in the reverse order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    /// Meters.
    pub translation: DVec3,
    /// A unit quaternion.
    pub rotation: DQuat,
    /// A factor for each axis.
    pub scale: DVec3,
}

impl Default for Transform {
    fn default() -> Self {
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

impl Transform {
    /// The parts of a matrix without shear. Those of a matrix that has no inverse are a guess.
    pub fn from_matrix(matrix: DMat4) -> Self {
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        let rotation = if rotation.is_finite() { rotation.normalize() } else { DQuat::IDENTITY };
        Self { translation, rotation, scale }
    }

    /// Parent from node.
    pub fn matrix(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// Mixes two rotations along the shorter arc, at an even speed (glTF 2.0, appendix C.4). Both are unit quaternions.
pub fn slerp(from: DQuat, to: DQuat, at: f64) -> DQuat {
    /// Below this angle, the sine differs from it by less than a double can tell, and mixing the numbers gives the same.
    const LEAST_ANGLE: f64 = 1e-7;
    let cosine = from.dot(to);
    let to = if cosine < 0.0 { -to } else { to };
    let angle = cosine.abs().min(1.0).acos();
    let mixed = if angle < LEAST_ANGLE {
        from * (1.0 - at) + to * at
    } else {
        (from * ((1.0 - at) * angle).sin() + to * (at * angle).sin()) * angle.sin().recip()
    };
    mixed.normalize()
}
