//! The textures of a scene: each image is decoded once, and its statistics are kept. One image is
//! decoded at a time.

use super::decode::{Image, MOST_TEXELS};
use super::notes::Read;
use super::schema::{Document, TextureInfo};
use super::statistics::{Joint, Statistics, bin_of};
use super::store::Store;
use crate::error::clean;
use std::collections::BTreeMap;
use std::rc::Rc;

/// All images together may have so many texels.
const MOST_TEXELS_OF_ALL: u64 = 64 * MOST_TEXELS;

/// So many images are read; the statistics of one take 16 KiB.
const MOST_IMAGES: usize = 4096;

/// So many pairs of images are compared; what is kept of one takes 12 KiB.
const MOST_PAIRS: usize = 4096;

/// The textures, and what is known of their images.
pub struct Textures<'a> {
    store: Store<'a>,
    images: BTreeMap<usize, Read<Rc<Statistics>>>,
    pairs: BTreeMap<(usize, usize), Read<Rc<Joint>>>,
    texels: u64,
}

impl<'a> Textures<'a> {
    /// Of a store.
    pub fn new(store: Store<'a>) -> Self {
        Textures { store, images: BTreeMap::new(), pairs: BTreeMap::new(), texels: 0 }
    }

    /// The statistics of a texture's image.
    pub fn statistics(&mut self, texture: TextureInfo) -> Read<Rc<Statistics>> {
        let image = image_of(self.store.document(), texture)?;
        if let Some(known) = self.images.get(&image) {
            return known.clone();
        }
        if self.images.len() >= MOST_IMAGES {
            return Err(format!("{MOST_IMAGES} images were read before it"));
        }
        let statistics = self.measure(image).map(Rc::new);
        self.images.insert(image, statistics.clone());
        statistics
    }

    /// The colours of a texture where the metalness of another (its B channel) is in each bin.
    pub fn joint(&mut self, metallic: TextureInfo, color: TextureInfo) -> Read<Rc<Joint>> {
        let document = self.store.document();
        let pair = (image_of(document, metallic)?, image_of(document, color)?);
        if let Some(known) = self.pairs.get(&pair) {
            return known.clone();
        }
        let headers = [self.statistics(metallic)?.header, self.statistics(color)?.header];
        let [first, second] = headers.map(|header| (header.width, header.height));
        let joint = if first != second || headers.iter().any(|header| header.levels) {
            Err("their sizes differ".into())
        } else if self.pairs.len() >= MOST_PAIRS {
            Err("too many pairs".into())
        } else {
            self.compare(pair).map(Rc::new)
        };
        self.pairs.insert(pair, joint.clone());
        joint
    }

    /// A texture for a line of text, after it was read.
    pub fn label(&self, texture: TextureInfo) -> String {
        let document = self.store.document();
        let Ok(image) = image_of(document, texture) else {
            return format!("texture {}", texture.index);
        };
        let found = document.images.get(image);
        let uri = found.and_then(|found| found.uri.as_deref());
        let file = uri.filter(|uri| !uri.starts_with("data:"));
        let file = file.and_then(|file| file.rsplit('/').next());
        let name = file.or(found.and_then(|found| found.name.as_deref()));
        let name = name.map(|name| clean(name, 40)).filter(|name| !name.is_empty());
        let name = name.unwrap_or_else(|| format!("image {image}"));
        match self.images.get(&image) {
            Some(Ok(statistics)) => {
                let header = statistics.header;
                format!("texture {} ({name}, {}x{})", texture.index, header.width, header.height)
            }
            _ => format!("texture {} ({name}, not read)", texture.index),
        }
    }

    fn measure(&mut self, image: usize) -> Read<Statistics> {
        let bytes = self.store.image(image)?;
        let image = Image::open(&bytes)?;
        let header = image.header();
        count(&mut self.texels, header.texels())?;
        let mut statistics = Statistics::new(header);
        image.decode(&mut |row| statistics.take(row))?;
        Ok(statistics)
    }

    /// Decodes both images again, and keeps a byte of each texel of the first meanwhile.
    fn compare(&mut self, (first, second): (usize, usize)) -> Read<Joint> {
        let bins = self.bins_of_metalness(first)?;
        let bytes = self.store.image(second)?;
        let image = Image::open(&bytes)?;
        count(&mut self.texels, image.header().texels())?;
        let mut joint = Joint::new();
        let mut rest = bins.as_slice();
        image.decode(&mut |row| {
            let (now, later) = rest.split_at(row.len().min(rest.len()));
            joint.take(now, row);
            rest = later;
        })?;
        Ok(joint)
    }

    fn bins_of_metalness(&mut self, image: usize) -> Read<Vec<u8>> {
        let bytes = self.store.image(image)?;
        let image = Image::open(&bytes)?;
        count(&mut self.texels, image.header().texels())?;
        let mut bins = Vec::new();
        image.decode(&mut |row| bins.extend(row.iter().map(|texel| bin_of(texel[2]) as u8)))?;
        Ok(bins)
    }
}

/// Counts texels that are about to be decoded.
fn count(texels: &mut u64, more: u64) -> Read<()> {
    *texels = texels.saturating_add(more);
    if *texels > MOST_TEXELS_OF_ALL {
        return Err("the images before it have 4 Gi texels".into());
    }
    Ok(())
}

/// The image of a texture: that of an extension, since an engine that knows it takes that one.
fn image_of(document: &Document, texture: TextureInfo) -> Read<usize> {
    let index = texture.index;
    let found =
        document.textures.get(index).ok_or_else(|| format!("there is no texture {index}"))?;
    let extensions = &found.extensions;
    let others = [extensions.basisu, extensions.webp, extensions.avif, extensions.dds];
    let other = others.into_iter().flatten().find_map(|other| other.source);
    other.or(found.source).ok_or_else(|| "it has no image".into())
}
