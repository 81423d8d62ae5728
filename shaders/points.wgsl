// The points of an estimator in place of a rule's nodes: more of them than a uniform has room for.
@group(0) @binding(0) var<storage, read> nodes: array<vec2<f32>>;
