//! Accessors: typed elements in buffer views, with strides, normalisation and sparse values.
//!
//! Every range is checked against the bytes that are there before anything is allocated.

use super::buffers::Buffers;
use super::component::{Component, code, signed_normalized};
use super::document::{Accessor, Document, Sparse};
use crate::import::Problem;
use crate::import::budget::Budget;

/// Reads accessors of one document.
#[derive(Debug)]
pub struct AccessorReader<'a> {
    /// The document.
    pub document: &'a Document,
    /// Its bytes.
    pub buffers: &'a Buffers<'a>,
    /// What it may still allocate.
    pub budget: &'a Budget,
}

/// Which elements of an accessor are wanted.
#[derive(Clone, Debug, Default)]
pub enum Selection {
    /// All of them.
    #[default]
    All,
    /// These, in rising order.
    Only(Vec<u32>),
}

/// Elements at equal distances.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl<'a> Elements<'a> {
    fn get(&self, index: usize) -> &'a [u8] {
        let start = index * self.stride;
        &self.bytes[start..start + self.size]
    }
}

impl AccessorReader<'_> {
    /// How many elements accessor `index` has, after a check that it really has them.
    ///
    /// # Errors
    /// Where its bytes are not there, or it stands for zeros out of all proportion.
    pub fn count(&self, index: usize) -> Result<usize, Problem> {
        let accessor = self.get(index)?;
        let (size, count) = self.layout(index, accessor)?;
        match accessor.buffer_view {
            Some(view) => {
                let stride = self.stride(view);
                self.elements(index, view, accessor.byte_offset, stride, size, count)?;
            }
            None => self.budget.check_zeros(count as u64 * size as u64)?,
        }
        Ok(count)
    }

    /// Elements of `N` numbers each, as floats.
    ///
    /// # Errors
    /// Where the accessor is not there, has another shape, or reaches past its bytes.
    pub fn floats<const N: usize>(
        &self,
        index: usize,
        selection: &Selection,
    ) -> Result<Vec<[f32; N]>, Problem> {
        let accessor = self.get(index)?;
        let normalized = accessor.normalized;
        match accessor.component_type {
            code::F32 => self.read(index, selection, |c: f32| c),
            code::I8 if normalized => {
                self.read(index, selection, |c: i8| signed_normalized(c, i8::MAX))
            }
            code::U8 if normalized => self.read(index, selection, |c: u8| f32::from(c) / 255.0),
            code::I16 if normalized => {
                self.read(index, selection, |c: i16| signed_normalized(c, i16::MAX))
            }
            code::U16 if normalized => self.read(index, selection, |c: u16| f32::from(c) / 65535.0),
            code::U32 if normalized => self.read(index, selection, |c: u32| {
                (f64::from(c) / f64::from(u32::MAX)) as f32
            }),
            code::I8 => self.read(index, selection, |c: i8| f32::from(c)),
            code::U8 => self.read(index, selection, |c: u8| f32::from(c)),
            code::I16 => self.read(index, selection, |c: i16| f32::from(c)),
            code::U16 => self.read(index, selection, |c: u16| f32::from(c)),
            code::U32 => self.read(index, selection, |c: u32| c as f32),
            other => Err(unknown_component(index, other)),
        }
    }

    /// Elements of `N` numbers each, as unsigned integers.
    ///
    /// # Errors
    /// As for [`Self::floats`], and where the numbers are signed or floats.
    pub fn integers<const N: usize>(
        &self,
        index: usize,
        selection: &Selection,
    ) -> Result<Vec<[u32; N]>, Problem> {
        match self.get(index)?.component_type {
            code::U8 => self.read(index, selection, |c: u8| u32::from(c)),
            code::U16 => self.read(index, selection, |c: u16| u32::from(c)),
            code::U32 => self.read(index, selection, |c: u32| c),
            code::I8 | code::I16 | code::F32 => Err(Problem::Invalid(format!(
                "accessor {index}: its numbers must be unsigned integers"
            ))),
            other => Err(unknown_component(index, other)),
        }
    }

    /// Accessor `index` of the document.
    ///
    /// # Errors
    /// Where it is not there.
    pub fn get(&self, index: usize) -> Result<&Accessor, Problem> {
        let accessors = &self.document.accessors;
        accessors.get(index).ok_or_else(|| {
            Problem::Invalid(format!(
                "accessor {index}: there are only {}",
                accessors.len()
            ))
        })
    }

    fn read<C: Component, T: Copy + Default, const N: usize>(
        &self,
        index: usize,
        selection: &Selection,
        convert: impl Fn(C) -> T,
    ) -> Result<Vec<[T; N]>, Problem> {
        let accessor = self.get(index)?;
        if accessor.kind.components() != Some(N) {
            return Err(Problem::Invalid(format!(
                "accessor {index}: elements of {N} numbers are needed, and it is {}",
                accessor.kind
            )));
        }
        let element = |bytes: &[u8]| -> [T; N] {
            std::array::from_fn(|i| convert(C::read_le(&bytes[i * C::SIZE..])))
        };
        let count = self.count(index)?;
        if let Selection::Only(wanted) = selection
            && let Some(&last) = wanted.last()
            && last as usize >= count
        {
            return Err(Problem::Invalid(format!(
                "accessor {index}: has only {count} elements"
            )));
        }
        let taken = match selection {
            Selection::All => count,
            Selection::Only(wanted) => wanted.len(),
        };
        self.budget
            .take(taken as u64 * size_of::<[T; N]>() as u64)?;
        let mut values = match accessor.buffer_view {
            None => vec![[T::default(); N]; taken],
            Some(view) => {
                let (stride, size) = (self.stride(view), N * C::SIZE);
                let all = self.elements(index, view, accessor.byte_offset, stride, size, count)?;
                match selection {
                    Selection::All => (0..count).map(|i| element(all.get(i))).collect(),
                    Selection::Only(wanted) => {
                        let get = |&i: &u32| element(all.get(i as usize));
                        wanted.iter().map(get).collect()
                    }
                }
            }
        };
        if let Some(sparse) = &accessor.sparse {
            for (place, bytes) in self.replacements(index, sparse, N * C::SIZE, count)? {
                let slot = match selection {
                    Selection::All => Some(place as usize),
                    Selection::Only(wanted) => wanted.binary_search(&place).ok(),
                };
                if let Some(slot) = slot {
                    values[slot] = element(bytes);
                }
            }
        }
        Ok(values)
    }

    /// Which of the `count` elements of `size` bytes are replaced, and by what.
    fn replacements(
        &self,
        index: usize,
        sparse: &Sparse,
        size: usize,
        count: usize,
    ) -> Result<Vec<(u32, &[u8])>, Problem> {
        let problem = |what: String| Problem::Invalid(format!("accessor {index}: {what}"));
        let (places, values) = (&sparse.indices, &sparse.values);
        let replaced = to_usize(sparse.count).filter(|&n| n <= count);
        let replaced = replaced
            .ok_or_else(|| problem(format!("replaces {} of {count} elements", sparse.count)))?;
        let bytes_of_each = size + size_of::<(u32, &[u8])>();
        self.budget.take((replaced * bytes_of_each) as u64)?;
        let width = component_size(index, places.component_type)?;
        let missing = |of: &str| problem(format!("its sparse {of} name no bufferView"));
        let places_view = places.buffer_view.ok_or_else(|| missing("indices"))?;
        let values_view = values.buffer_view.ok_or_else(|| missing("values"))?;
        let at = self.elements(index, places_view, places.byte_offset, 0, width, replaced)?;
        let new = self.elements(index, values_view, values.byte_offset, 0, size, replaced)?;
        let place = |i: usize| match places.component_type {
            code::U8 => Ok(u32::from(u8::read_le(at.get(i)))),
            code::U16 => Ok(u32::from(u16::read_le(at.get(i)))),
            code::U32 => Ok(u32::read_le(at.get(i))),
            other => Err(unknown_component(index, other)),
        };
        let pair = |i: usize| match place(i)? {
            place if (place as usize) < count => Ok((place, new.get(i))),
            place => Err(problem(format!("replaces element {place} of {count}"))),
        };
        (0..replaced).map(pair).collect()
    }

    /// Bytes of an element, and how many there are.
    fn layout(&self, index: usize, accessor: &Accessor) -> Result<(usize, usize), Problem> {
        let width = component_size(index, accessor.component_type)?;
        let components = accessor.kind.components().ok_or_else(|| {
            Problem::Invalid(format!("accessor {index}: of a type that is not known"))
        })?;
        let count = to_usize(accessor.count).filter(|&n| u32::try_from(n).is_ok());
        let count = count.ok_or_else(|| {
            Problem::Invalid(format!("accessor {index}: {} elements", accessor.count))
        })?;
        Ok((width * components, count))
    }

    /// The distance of elements in a buffer view; 0 where they are packed.
    fn stride(&self, view: usize) -> u64 {
        let view = self.document.buffer_views.get(view);
        view.map_or(0, |view| view.byte_stride)
    }

    /// `count` elements of `size` bytes that begin at `offset` in buffer view `view`.
    fn elements(
        &self,
        index: usize,
        view: usize,
        offset: u64,
        stride: u64,
        size: usize,
        count: usize,
    ) -> Result<Elements<'_>, Problem> {
        let problem = |what: String| Problem::Invalid(format!("accessor {index}: {what}"));
        let bytes = self.buffers.view(self.document, view)?;
        let stride = if stride == 0 { size as u64 } else { stride };
        if stride < size as u64 {
            return Err(problem(format!(
                "elements of {size} bytes cannot lie {stride} bytes apart"
            )));
        }
        let span = (count as u64).checked_sub(1).map_or(Some(0), |gaps| {
            gaps.checked_mul(stride)?.checked_add(size as u64)
        });
        let range = span
            .and_then(|span| span.checked_add(offset))
            .filter(|&end| end <= bytes.len() as u64);
        if range.is_none() {
            return Err(problem(format!(
                "{count} elements do not fit into the {} bytes of bufferView {view}",
                bytes.len()
            )));
        }
        Ok(Elements {
            // Within bounds, so neither cast can lose anything, except for no elements at all.
            bytes: bytes.get(offset as usize..).unwrap_or_default(),
            stride: usize::try_from(stride).unwrap_or(size),
            size,
        })
    }
}

fn to_usize(number: u64) -> Option<usize> {
    usize::try_from(number).ok()
}

fn component_size(index: usize, component_type: u32) -> Result<usize, Problem> {
    match component_type {
        code::I8 | code::U8 => Ok(1),
        code::I16 | code::U16 => Ok(2),
        code::U32 | code::F32 => Ok(4),
        other => Err(unknown_component(index, other)),
    }
}

fn unknown_component(index: usize, component_type: u32) -> Problem {
    Problem::Invalid(format!(
        "accessor {index}: componentType {component_type} is not known"
    ))
}
