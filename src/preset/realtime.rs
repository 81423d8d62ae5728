//! Engines that render in real time.

use super::Preset;

pub const PRESETS: &[Preset] = &[
    Preset {
        name: "filament",
        about: "Filament's table of 128 x 128: (B, E) and cloth",
        flags: "--channels b,e,charlie --size 128 --precision f16 --format raw",
        file: "dfg.bin",
        only_size: true,
        source: "google/filament: libs/ibl/src/CubemapIBL.cpp, filament/src/DFG.cpp, \
                 shaders/src/surface_light_indirect.fs",
        stored: "R = B, G = E, B = E of Charlie with Neubelt's visibility, as RGB16F side by side; \
                 row 0 is smooth. The engine checks the size: 98,304 bytes.",
        lookup: "(n.v, perceptual roughness)",
        import: "Put it where the build's rule of cmgen writes dfg.bin. Older versions include \
                 numbers instead: --format txt -o dfg.inc.",
        faults: "Row j holds the roughness (j+1.5)/N, one texel too rough: B is off by up to \
                 0.037, E by 0.031 (--y roughness,offset=1.5 repeats it). 1,024 samples.",
    },
    Preset {
        name: "filament-mobile",
        about: "the same at 64 x 64, as for Android, iOS and the web",
        flags: "--channels b,e,charlie --size 64 --precision f16 --format raw",
        file: "dfg.bin",
        only_size: true,
        source: "google/filament: filament/CMakeLists.txt (IS_MOBILE_TARGET)",
        stored: "As filament; 24,576 bytes.",
        lookup: "(n.v, perceptual roughness)",
        import: "As filament.",
        faults: "As filament, and the shift is twice as large: as sampled 0.067 at the most, 0.042 \
                 without it.",
    },
    Preset {
        name: "babylon",
        about: "Babylon.js' environment BRDF: (B, E) and sheen",
        flags: "--channels b,e,charlie --size 256 --precision rgbd8",
        file: "environment_brdf.png",
        only_size: false,
        source: "npm @babylonjs/core 9.35.0: Misc/brdfTextureTools.js, \
                 Shaders/ShadersInclude/pbrBRDFFunctions.js",
        stored: "R = B, G = E, B = E of Charlie with Neubelt's visibility, as RGBD; row 0 is \
                 smooth.",
        lookup: "(n.v, perceptual roughness)",
        import: "scene.environmentBRDFTexture = new Texture(url, scene, true, false, \
                 Texture.BILINEAR_SAMPLINGMODE), wrapU and wrapV to clamp, isRGBD = true, then \
                 RGBDTextureTools.ExpandRGBDTexture. Near grazing Charlie reaches 36, and the \
                 shared divisor leaves few bits to R and G: --precision f16 -o \
                 environment_brdf.dds has no such limit (isRGBD = false, no expansion).",
        faults: "Row j holds the roughness (j+1.5)/N, and 8 bits: 1.1e-3 on the average, 0.019 at \
                 the most.",
    },
    Preset {
        name: "babylon-openpbr",
        about: "Babylon.js' table of its OpenPBR material: (B, E) and the F82 term",
        flags: "--fresnel f82 --channels b,e,c*16 --size 128 --precision rgbd8",
        file: "openpbr_environment_brdf.png",
        only_size: false,
        source: "npm @babylonjs/core 9.35.0: Misc/brdfTextureTools.js",
        stored: "R = B, G = E, B = 16 C, as RGBD; row 0 is smooth.",
        lookup: "(n.v, perceptual roughness)",
        import: "scene.openPBREnvironmentBRDFTexture, with the settings of babylon.",
        faults: "The picture is written on the curve of sRGB and read by a power of 2.2: 3.6e-3 on \
                 the average, 0.0143 at the most.",
    },
    Preset {
        name: "gltf",
        about: "lut_ggx.png of Khronos' glTF sampler and viewers",
        flags: "--channels ab --size 1024 --precision unorm8",
        file: "lut_ggx.png",
        only_size: false,
        source: "KhronosGroup/glTF-IBL-Sampler: lib/shaders/filter.frag; glTF-Sample-Renderer: \
                 source/Renderer/shaders/ibl.glsl",
        stored: "R = A, G = B; row 0 is smooth. Blue, Charlie's E, exceeds what 8 bits hold near \
                 grazing: --channels 0,0,charlie --precision f16 -o lut_charlie.exr is a picture \
                 of it alone.",
        lookup: "(n.v, perceptual roughness)",
        import: "No sRGB, no mips, linear, clamp to the edge, UNPACK_FLIP_Y_WEBGL off.",
        faults: "8 bits and 1,024 samples: 1.1e-3 on the average, 0.021 at the most. The Charlie \
                 table that the renderer makes in a browser is off by a factor of 0.9 to 1.6.",
    },
    Preset {
        name: "threejs",
        about: "three.js' table of 16 x 16 (r181 and later)",
        flags: "--channels ab --x roughness --y nov --size 16 --precision f16 --symbol DATA",
        file: "DFGLUTData.js",
        only_size: false,
        source: "npm three 0.187.0: src/renderers/shaders/DFGLUTData.js, \
                 src/nodes/functions/BSDF/DFGLUT.js",
        stored: "R = A, G = B as halves; roughness runs along a row, row 0 is grazing.",
        lookup: "(roughness, n.v)",
        import: "Put the array DATA in place of theirs, in both files: no property reaches it.",
        faults: "4,096 samples: a stored value is off by up to 0.0142. Read between texels E(F0) \
                 is off by up to 0.148, for want of texels: at --size 64 by 0.109.",
    },
    Preset {
        name: "bevy",
        about: "Bevy's table",
        flags: "--channels ab --size 64 --precision f16",
        file: "dfg.ktx2",
        only_size: false,
        source: "crate bevy_pbr 0.20.1: src/environment_map/dfg.ktx2, src/render/pbr_lighting.wesl",
        stored: "R = A, G = B as RG16F; row 0 is smooth.",
        lookup: "(n.v, perceptual roughness)",
        import: "Load it with is_srgb = false and ImageSampler::linear(), and insert DfgLut before \
                 PbrPlugin; or replace src/environment_map/dfg.ktx2 and rebuild.",
        faults: "1.3e-4 on the average and 6.3e-3 at the most in a stored value: the best of those \
                 that engines ship.",
    },
    Preset {
        name: "unreal",
        about: "Unreal Engine's PreIntegratedGF of 128 x 32",
        flags: "--masking height-correlated-approx --channels ab --size 128x32 --precision f16",
        file: "T_PreIntegratedGF.exr",
        only_size: false,
        source: "Unreal Engine 5: Renderer/Private/SystemTextures.cpp, Shaders/Private/BRDF.ush \
                 (EnvBRDF)",
        stored: "R = A, G = B by the approximation of the joint term; row 0 is smooth. The \
                 engine's own is RG16 unorm: --precision unorm16 -o gf.h for a patch.",
        lookup: "(n.v, roughness)",
        import: "Texture asset: Compression HDR, sRGB off, Mip Gen Settings NoMipmaps, tiling \
                 Clamp, filter Bilinear. The engine computes its own at start-up: patch \
                 SystemTextures.cpp to use this everywhere.",
        faults: "128 samples: A is off by up to 0.035. Against the exact term, which --masking \
                 height-correlated bakes, 0.028 on the average and 0.22 at the most.",
    },
    Preset {
        name: "hdrp",
        about: "Unity HDRP's FGD table: (B, E) and Disney diffuse",
        flags: "--channels b,e,burley*0.9655212-0.5 --x nov,sqrt,edges --y roughness,edges,flip \
                --size 64 --precision f16",
        file: "PreIntegratedFGD_GGXDisneyDiffuse.exr",
        only_size: true,
        source: "Unity-Technologies/Graphics: high-definition/Runtime/Material/PreIntegratedFGD, \
                 core/ShaderLibrary/ImageBasedLighting.hlsl",
        stored: "R = B, G = E, B = Burley's albedo/1.03571 - 1/2. Nodes at i/(N-1), x = sqrt(n.v). \
                 Unity turns pictures: row 0 of the file, its top, is rough.",
        lookup: "(sqrt(n.v), perceptual roughness) * 63/64 + 0.5/64",
        import: "sRGB off, Generate Mip Maps off, Wrap Clamp, Filter Bilinear, Compression None, \
                 Format RGBA Half. The engine computes its own: patch PreIntegratedFGD.Bind. For \
                 LoadRawTextureData leave out flip: --y roughness,edges -o fgd.raw.",
        faults: "A2B10G10R10: a step is 1e-3, and blue, from -0.029 to 1.004, is cut off at both \
                 ends.",
    },
    Preset {
        name: "hdrp-charlie",
        about: "Unity HDRP's FGD table of cloth: Charlie and fabric Lambert",
        flags: "--model charlie --masking height-correlated --channels \
                b*0.15915494309189535,e*0.15915494309189535,fabric-lambert --y roughness,flip \
                --size 64 --precision f16",
        file: "PreIntegratedFGD_CharlieAndFabric.exr",
        only_size: false,
        source: "Unity-Technologies/Graphics: preIntegratedFGD_CharlieFabricLambert.shader, \
                 BSDF.hlsl",
        stored: "R = B/(2 pi), G = E/(2 pi), B = 1 - alpha/2; the shader multiplies by 2 pi. Unity \
                 turns pictures: row 0 of the file, its top, is rough.",
        lookup: "(n.v, perceptual roughness)",
        import: "As hdrp; the global texture is _PreIntegratedFGD_CharlieAndFabric.",
        faults: "10 bits of values divided by 2 pi: a step is 6e-3 of E. Direct light uses \
                 another visibility (Ashikhmin's), 0.063 apart on the average of roughness above \
                 0.2.",
    },
    Preset {
        name: "godot",
        about: "Godot 4's table of Forward+",
        flags: "--masking schlick-smith --channels be --y roughness,flip --size 128 --precision \
                f16 --components 2",
        file: "dfg_lut.dds",
        only_size: false,
        source: "godotengine/godot: servers/rendering/renderer_rd/shaders/forward_clustered/\
                 integrate_dfg.glsl, scene_forward_clustered_inc.glsl",
        stored: "R = B, G = E by Schlick's term with k = alpha/2; row 0 is rough.",
        lookup: "(n.v, 1 - roughness)",
        import: "Import as VRAM Uncompressed or Lossless, without mipmaps. The engine computes its \
                 own at start-up: patch where it does.",
        faults: "Some versions hold the roughness (N-j+0.5)/N, one texel too rough and 1.0039 in \
                 row 0: E is off by up to 0.078 (--y roughness,offset=1.5,flip,unclamped repeats \
                 it). Against the exact Smith term 0.042 on the average and 0.31 at the most.",
    },
    Preset {
        name: "o3de",
        about: "Open 3D Engine's BRDF texture",
        flags: "--channels ab --y roughness,flip --size 256 --precision f16 --components 2",
        file: "brdf_lut.dds",
        only_size: false,
        source: "o3de/o3de: \
                 Gems/Atom/Feature/Common/Assets/Shaders/BRDFTexture/BRDFTextureCS.azsl, \
                 LightingUtils.azsli",
        stored: "R = A, G = B as RG16F; row 0 is rough.",
        lookup: "(n.v, 1 - roughness)",
        import: "An image preset without sRGB and mips. The engine computes its own: point the \
                 pass's attachment at the asset.",
        faults: "The noise of 1,024 samples.",
    },
    Preset {
        name: "donut",
        about: "NVIDIA Donut's environment BRDF",
        flags: "--channels ab --size 64 --precision f16 --components 2",
        file: "environment_brdf.dds",
        only_size: false,
        source: "NVIDIA-RTX/Donut: shaders/passes/light_probe.hlsl, \
                 src/render/LightProbeProcessingPass.cpp",
        stored: "R = A, G = B as RG16F; row 0 is smooth.",
        lookup: "(n.v, roughness)",
        import: "TextureCache::LoadTextureFromFile(path, false), bound in place of \
                 GetEnvironmentBrdfTexture().",
        faults: "The noise of 1,024 samples.",
    },
];
