//! Toolkits, standards and tutorials.

use super::Preset;

pub const PRESETS: &[Preset] = &[
    Preset {
        name: "materialx",
        about: "MaterialX' table of directional albedo: (A, B) and sheen",
        flags: "--channels a,b,charlie --y alpha --size 64 --precision f32",
        file: "AlbedoTable.exr",
        only_size: false,
        source: "AcademySoftwareFoundation/MaterialX: libraries/pbrlib/genglsl/lib/mx_table.glsl",
        stored: "R = A, G = B, B = E of Charlie with Neubelt's visibility. A row is one alpha of \
                 both: sheen's own roughness is not squared.",
        lookup: "(n.v, alpha), for sheen (n.v, roughness)",
        import: "lightHandler->setAlbedoTable(image), hwDirectionalAlbedoMethod = TABLE; linear, \
                 clamp.",
        faults: "64 samples: A is off by up to 0.015. The fit that is the default errs by up to \
                 0.11.",
    },
    Preset {
        name: "learnopengl",
        about: "LearnOpenGL's table, as in many renderers that follow it",
        flags: "--masking schlick-smith --channels ab --size 512 --precision f16 --format raw",
        file: "brdf_lut.raw",
        only_size: false,
        source: "JoeyDeVries/LearnOpenGL: src/6.pbr/2.2.2.ibl_specular_textured/2.2.2.brdf.fs",
        stored: "R = A, G = B by Schlick's term with k = alpha/2, as RG16F; row 0 is smooth.",
        lookup: "(n.v, roughness)",
        import: "glTexImage2D(GL_TEXTURE_2D, 0, GL_RG16F, 512, 512, 0, GL_RG, GL_HALF_FLOAT, \
                 data); linear, clamp to the edge, no mips.",
        faults: "Against the exact Smith term 0.042 on the average and 0.31 at the most; 1,024 \
                 samples.",
    },
    Preset {
        name: "vtk",
        about: "VTK's vtkPBRLUTTexture",
        flags: "--masking schlick-smith --channels ab --size 512 --precision unorm16 --format raw",
        file: "vtk_pbr_lut.raw",
        only_size: false,
        source: "Kitware/VTK: Rendering/OpenGL2/vtkPBRLUTTexture.cxx",
        stored: "R = A, G = B by Schlick's term with k = alpha/2, as RG16 unorm; row 0 is smooth.",
        lookup: "(n.v, roughness)",
        import: "No file is loaded: vtkTextureObject::Create2DFromRaw(512, 512, 2, \
                 VTK_UNSIGNED_SHORT, data) in a class of your own.",
        faults: "Against the exact Smith term 0.042 on the average and 0.31 at the most.",
    },
];
