//! Renderers that trace paths, and their libraries.

use super::Preset;

pub const PRESETS: &[Preset] = &[
    Preset {
        name: "cycles-e",
        about: "Cycles' albedo of GGX, table_ggx_E",
        flags: "--channels e --x roughness,edges,min=1e-4 --y nov,edges,min=1e-4 --size 32 \
                --precision f32 --symbol table_ggx_E",
        file: "table_ggx_E.h",
        only_size: true,
        source: "blender/blender: intern/cycles/scene/shader.tables, \
                 intern/cycles/app/cycles_precompute.cpp",
        stored: "E; roughness runs along a row, nodes at i/31 and both from 1e-4 on.",
        lookup: "linear between nodes (lookup_table_read_2D)",
        import: "Put the array into shader.tables and rebuild.",
        faults: "None: 9.8e-7 at the most, of six decimals.",
    },
    Preset {
        name: "cycles-eavg",
        about: "Cycles' average albedo of GGX, table_ggx_Eavg",
        flags: "--channels e_avg --x roughness,edges,min=1e-4 --y nov --size 32x1 --precision f32 \
                --symbol table_ggx_Eavg",
        file: "table_ggx_Eavg.h",
        only_size: true,
        source: "blender/blender: intern/cycles/scene/shader.tables",
        stored: "E averaged over the hemisphere; roughness at i/31, from 1e-4 on.",
        lookup: "linear between nodes (lookup_table_read)",
        import: "Put the array into shader.tables and rebuild.",
        faults: "None: 6.1e-7 at the most.",
    },
    Preset {
        name: "eevee",
        about: "EEVEE's split sum with the F82 term, brdf_ggx",
        flags: "--masking separable --fresnel f82 --channels abc --x roughness,edges --y \
                nov,sqrt-complement,edges,min=1e-4,max=0.9999 --size 64 --precision f32 --symbol \
                brdf_ggx",
        file: "brdf_ggx.h",
        only_size: true,
        source: "blender/blender: source/blender/draw/engines/eevee: eevee_lut_comp.glsl, \
                 eevee_lut.cc, eevee_utility_tx_lib.glsl",
        stored: "A, B, C by the separable term; roughness runs along a row, y = sqrt(1 - n.v), \
                 nodes at i/63. Refraction (btdf_ggx, bsdf_ggx) is left out.",
        lookup: "(roughness, sqrt(1 - n.v)) * 63/64 + 0.5/64",
        import: "Put the array into eevee_lut.cc and rebuild. Before F82: --channels a,b.",
        faults: "262,144 terms are added in single precision: A is too high by up to 3.4e-3 where \
                 smooth, and A + B exceeds 1.",
    },
    Preset {
        name: "ospray",
        about: "OSPRay's albedo of GGX",
        flags: "--channels e --x nov,edges,min=1e-6 --y roughness,edges,min=0.0316227766 --size 32 \
                --precision f32 --format raw",
        file: "microfacet_albedo.raw",
        only_size: true,
        source: "RenderKit/ospray: modules/cpu/render/bsdfs/MicrofacetAlbedoTables.ispc",
        stored: "E; nodes at i/31, alpha from 0.001 on. Its average: --channels e_avg --x \
                 roughness,edges,min=0.0316227766 --y nov --size 32x1. The dielectric and the \
                 sheen tables are left out.",
        lookup: "linear between nodes (MicrofacetAlbedo_dir)",
        import: "No file is loaded: fill the array in MicrofacetAlbedoTables_create and rebuild.",
        faults: "The noise of 1,024 samples.",
    },
    Preset {
        name: "openpbr",
        about: "Adobe openpbr-bsdf's complement of the albedo of ideal metals",
        flags: "--masking separable --channels 1-e --x nov,edges,min=1e-3 --y roughness,edges \
                --size 32 --precision unorm16 --format txt",
        file: "openpbr_ideal_metal_energy_complement_data.h",
        only_size: true,
        source: "adobe/openpbr-bsdf: impl/data/openpbr_energy_arrays.h, \
                 impl/openpbr_energy_array_access.h",
        stored: "1 - E as u16; n.v runs along a row, nodes at i/31, the first n.v at 1e-3. Its \
                 average: --channels e_avg*-1+1 --x roughness,edges --y nov --size 32x1. The \
                 dielectric tables and the fuzz are left out.",
        lookup: "linear between nodes; as a texture (n.v, roughness) * 31/32 + 0.5/32",
        import: "Replace the file, which is included between the braces of an array, and rebuild.",
        faults: "None but the rounding to 16 bits, as far as it was measured.",
    },
    Preset {
        name: "ltc-magnitude",
        about: "E and B beside linearly transformed cosines (ltc_2, LTC_MAT_2)",
        flags: "--channels e,b --x roughness,edges,min=0.0031622777 --y \
                nov,sqrt-complement,edges,min=7.963e-4 --size 64 --precision f32 --symbol \
                ltc_magnitude",
        file: "ltc_magnitude.h",
        only_size: true,
        source: "selfshadow/ltc_code: fit/fitLTC.cpp; npm three: \
                 examples/jsm/lights/RectAreaLightTexturesLib.js",
        stored: "E, B; roughness runs along a row, y = sqrt(1 - n.v), nodes at i/63, alpha from \
                 1e-5 on. The table's fourth channel, of the clipped sphere, is no integral of a \
                 BRDF: keep it.",
        lookup: "(roughness, sqrt(1 - n.v)) * 63/64 + 0.5/64",
        import: "Put the two columns in place of the first two of ltc_2: linear, clamp, no mips.",
        faults: "E is too low by up to 0.066 in the last four rows, at grazing.",
    },
];
