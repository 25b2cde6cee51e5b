// The choices of BRDF models. Each is a list in the window and an option of `--set`. Models that are not selected cost
// nothing at run time.
//
// Each choice may make two claims, which `specula brdf` checks against the code:
//
//   conserves    a white surface reflects no more light than it receives, at every roughness
//   reciprocal   f(l, v) = f(v, l)
//
// A combination makes the claims that all of its choices make. Energy is conserved within 0.3 % up to 89.9 degrees from the
// normal; RenormalizedBurley is, up to 85 degrees, from where its fit gains up to 2.9 % (measured: roughness 1, 89.9 degrees).
//
// The claims hold for materials without extensions, so for an index of refraction of 1.5: for other indices, Exact with
// the Albedo coupling gains up to 2 % (measured: n = 1.1, grazing). Each model's file gives its formula and source. The
// energy claims follow from: Kulla & Conty 2017 and Fdez-Aguera 2019 (multiple scattering), Kelemen & Szirmay-Kalos 2001
// (Albedo coupling), Portsmouth et al. 2025 (EON, OrenNayar). These choices make fewer claims:
//
//   Burley, CallOfDuty    fits to the look of real surfaces; both gain energy at grazing angles.
//   Coupling GltfSample   glTF 2.0, appendix B.3.5. Light enters by 1 - F(VoH), but at a grazing v the surface reflects
//                         about F(NoV), while VoH is far from grazing for most l: the two sum to more than 1, by 59 %
//                         at 85 degrees.
//   FdezAguera            distributes the energy that v misses uniformly over l: the albedo is 1, but l and v differ.
#ifndef BRDF_MODELS_GLSL
#define BRDF_MODELS_GLSL

#include "interface.glsl"

const uint HEIGHT_CORRELATED = 0u;
const uint SEPARABLE = 1u;
const uint SCHLICK_MASKING = 2u;
//@ui "Masking-shadowing" choice HeightCorrelated=0 "Smith masking and shadowing that depend on each other by height (Heitz 2014, eq. 99)" Separable=1 "Smith masking times shadowing, as if they were independent (Walter et al. 2007, eq. 23): darker at grazing angles" Schlick=2 "A fit without a square root (Schlick 1994, eq. 19; Karis 2013)" group="BRDF" doc="Microfacets that others hide: Smith's functions, height-correlated (Heitz 2014) or separable, or Schlick's fit" conserves="HeightCorrelated Separable Schlick" reciprocal="HeightCorrelated Separable Schlick"
layout(constant_id = USER_CONSTANTS + 0) const uint MASKING_SHADOWING = HEIGHT_CORRELATED;

const uint GGX = 0u;
const uint BECKMANN = 1u;
//@ui "Normal distribution" choice GGX=0 "Sharp peak and long tails, so highlights have a glow (Walter et al. 2007, eq. 33)" Beckmann=1 "Gaussian slopes with short tails: highlights end soon (Beckmann & Spizzichino 1963)" group="BRDF" doc="How the microfacets' normals are spread: GGX (Walter et al. 2007) has long tails, Beckmann has short ones" conserves="GGX Beckmann" reciprocal="GGX Beckmann"
layout(constant_id = USER_CONSTANTS + 2) const uint NDF = GGX;

const uint LAMBERT = 0u;
const uint BURLEY = 1u;
const uint RENORMALIZED_BURLEY = 2u;
const uint OREN_NAYAR = 3u;
const uint CALL_OF_DUTY = 4u;
//@ui "Diffuse" choice Lambert=0 "Equal radiance in all directions: albedo / pi (Lambert 1760)" Burley=1 "Retroreflection at grazing angles that grows with roughness (Burley 2012); gains energy" RenormalizedBurley=2 "Burley's model scaled so that it gains almost no energy (Lagarde & de Rousiers 2014)" OrenNayar=3 "Rough matte facets that flatten toward the edge, with energy conserved: EON (Portsmouth et al. 2025)" CallOfDuty=4 "A fit of diffuse light from microfacets, by roughness (Chan 2018)" group="BRDF" doc="Light that leaves from below the surface. Burley 2012; renormalized; Oren-Nayar as EON (Portsmouth et al. 2025)" conserves="Lambert RenormalizedBurley OrenNayar" reciprocal="Lambert Burley RenormalizedBurley OrenNayar CallOfDuty"
layout(constant_id = USER_CONSTANTS + 3) const uint DIFFUSE = LAMBERT;

const uint SCHLICK_DIELECTRIC = 0u;
const uint EXACT_DIELECTRIC = 1u;
//@ui "Fresnel, dielectric" choice Schlick=0 "F0 + (1 - F0) (1 - cos)^5 (Schlick 1994, eq. 15)" Exact=1 "Fresnel's equations for unpolarized light, from the index of refraction" group="BRDF" doc="Reflectance of what is no metal, over the angle: Schlick's fit, or exact for unpolarized light" conserves="Schlick Exact" reciprocal="Schlick Exact"
layout(constant_id = USER_CONSTANTS + 4) const uint FRESNEL_DIELECTRIC = SCHLICK_DIELECTRIC;

const uint SCHLICK_METAL = 0u;
const uint CONDUCTOR_METAL = 1u;
const uint F82_METAL = 2u;
//@ui "Fresnel, metal" choice Schlick=0 "F0 + (1 - F0) (1 - cos)^5 (Schlick 1994, eq. 15)" Conductor=1 "Fresnel's equations with the complex index n + ik of the metal" F82=2 "Schlick with a tint at 82 degrees, where metals dip (Kutz et al. 2021)" group="BRDF" doc="Reflectance of metals, over the angle: Schlick's fit, exact from n and k, or with a color at 82 degrees" conserves="Schlick Conductor F82" reciprocal="Schlick Conductor F82"
layout(constant_id = USER_CONSTANTS + 5) const uint FRESNEL_METAL = SCHLICK_METAL;

const uint SINGLE_SCATTER = 0u;
const uint KULLA_CONTY = 1u;
const uint FDEZ_AGUERA = 2u;
//@ui "Multiple scattering" choice None=0 "Only the first bounce: rough metals lose light" KullaConty=1 "A lobe with the lost energy, symmetric in light and eye (Kulla & Conty 2017)" FdezAguera=2 "The lost energy spread evenly over the light (Fdez-Aguera 2019)" group="BRDF" doc="Light that bounces between microfacets (Kulla & Conty 2017, Fdez-Aguera 2019). Without it, rough metals are too dark" conserves="None KullaConty FdezAguera" reciprocal="None KullaConty"
layout(constant_id = USER_CONSTANTS + 6) const uint MULTI_SCATTER = KULLA_CONTY;

const uint GLTF_SAMPLE_COUPLING = 0u;
const uint ALBEDO_COUPLING = 1u;
//@ui "Diffuse coupling" choice GltfSample=0 "1 - F of one microfacet, as in glTF 2.0, B.3.5: can gain energy" Albedo=1 "1 - the albedo of the specular lobe: conserves energy" group="BRDF" doc="What the specular lobe leaves to the diffuse one: by albedo, which conserves energy, or as glTF 2.0, B.3.5 has it" conserves="Albedo" reciprocal="GltfSample Albedo"
layout(constant_id = USER_CONSTANTS + 7) const uint DIFFUSE_COUPLING = ALBEDO_COUPLING;

#endif
