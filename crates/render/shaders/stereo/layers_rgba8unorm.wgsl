// Joints of segments, at sweep column, row and layer.
@group(3) @binding(0) var layers: texture_storage_2d_array<rgba8unorm, write>;
