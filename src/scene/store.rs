//! The bytes of a scene: its buffers, each loaded once, and its images.

use super::notes::Read;
use super::schema::{Buffer, Document};
use super::uri;
use crate::error::Result;
use crate::error::clean;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Buffers from files are kept, so they may hold so many bytes together.
const MOST_BUFFER_BYTES: usize = 1 << 30;

/// Images from files are read one at a time, and together so many bytes.
const MOST_IMAGE_BYTES: u64 = 1 << 34;

/// The bytes of a scene.
pub struct Store<'a> {
    document: &'a Document,
    binary: Option<&'a [u8]>,
    files: &'a dyn Fn(&str) -> Result<Vec<u8>>,
    buffers: BTreeMap<usize, Read<Cow<'a, [u8]>>>,
    buffer_bytes: usize,
    image_bytes: u64,
}

impl<'a> Store<'a> {
    /// Of a document, the binary chunk of its GLB, and what fetches the files beside it.
    pub fn new(
        document: &'a Document,
        binary: Option<&'a [u8]>,
        files: &'a dyn Fn(&str) -> Result<Vec<u8>>,
    ) -> Self {
        let buffers = BTreeMap::new();
        Store { document, binary, files, buffers, buffer_bytes: 0, image_bytes: 0 }
    }

    /// The scene.
    pub fn document(&self) -> &'a Document {
        self.document
    }

    /// The bytes of a view of a buffer.
    pub fn view(&mut self, index: usize) -> Read<&[u8]> {
        let views = &self.document.buffer_views;
        let view = views.get(index).ok_or_else(|| format!("there is no buffer view {index}"))?;
        let buffer = self.buffer(view.buffer)?;
        let end = view.byte_offset.checked_add(view.byte_length);
        end.and_then(|end| buffer.get(view.byte_offset..end))
            .ok_or_else(|| format!("buffer view {index} leaves buffer {}", view.buffer))
    }

    /// The bytes of an image's file.
    pub fn image(&mut self, index: usize) -> Read<Cow<'_, [u8]>> {
        let images = &self.document.images;
        let image = images.get(index).ok_or_else(|| format!("there is no image {index}"))?;
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => match uri::data(uri) {
                Some(data) => data.map(Cow::Owned),
                None => self.image_file(uri).map(Cow::Owned),
            },
            (None, Some(view)) => self.view(view).map(Cow::Borrowed),
            (None, None) => Err("it has neither a URI nor a buffer view".into()),
        }
    }

    fn image_file(&mut self, uri: &str) -> Read<Vec<u8>> {
        if self.image_bytes > MOST_IMAGE_BYTES {
            return Err("the images before it have 16 GiB".into());
        }
        let bytes = self.file(uri)?;
        self.image_bytes += bytes.len() as u64;
        Ok(bytes)
    }

    fn file(&self, uri: &str) -> Read<Vec<u8>> {
        let path = uri::relative(uri)?;
        (self.files)(&path).map_err(|error| clean(&error.to_string(), 200))
    }

    fn buffer(&mut self, index: usize) -> Read<&[u8]> {
        if !self.buffers.contains_key(&index) {
            let buffer = self.load(index);
            self.buffers.insert(index, buffer);
        }
        match self.buffers.get(&index) {
            Some(Ok(bytes)) => Ok(bytes),
            Some(Err(why)) => Err(why.clone()),
            None => Err(format!("there is no buffer {index}")),
        }
    }

    fn load(&mut self, index: usize) -> Read<Cow<'a, [u8]>> {
        let buffers: &'a [Buffer] = &self.document.buffers;
        let buffer = buffers.get(index).ok_or_else(|| format!("there is no buffer {index}"))?;
        let Some(uri) = &buffer.uri else {
            let binary = self.binary.filter(|_| index == 0).map(Cow::Borrowed);
            return binary.ok_or_else(|| format!("buffer {index} has no data"));
        };
        if let Some(data) = uri::data(uri) {
            return data.map(Cow::Owned).map_err(|why| format!("buffer {index}: {why}"));
        }
        if self.buffer_bytes > MOST_BUFFER_BYTES {
            return Err(format!("the buffers before buffer {index} have 1 GiB"));
        }
        let bytes = self.file(uri).map_err(|why| format!("buffer {index}: {why}"))?;
        self.buffer_bytes += bytes.len();
        Ok(Cow::Owned(bytes))
    }
}
