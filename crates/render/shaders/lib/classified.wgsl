// A classified sample.
struct Classified {
    // Colour and log2 transmittance of one voxel length.
    entry: vec4f,
    // Gradient in metric space, where CLASSIFIER_HAS_GRADIENT or what comes next asks for it.
    gradient: vec3f,
}
