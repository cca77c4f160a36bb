//! The functions of the library that are called, as its header `oidn.h` declares them.
//!
//! All `unsafe` code of denoising is here, behind [`Library`], which nobody can use wrongly.

#![allow(unsafe_code)]

use std::error::Error;
use std::ffi::{CStr, OsStr, c_char, c_int, c_void};
use std::ptr;

use libloading::{Library as Loaded, Symbol};

use crate::math::UVec2;

/// `OIDN_DEVICE_TYPE_CPU`: the picture is in the processor's memory, and is the same on every machine of a kind.
const CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`.
const FLOAT3: c_int = 3;

/// A device or a filter of the library.
type Handle = *mut c_void;
type NewDevice = unsafe extern "C" fn(c_int) -> Handle;
type OnHandle = unsafe extern "C" fn(Handle);
type GetInt = unsafe extern "C" fn(Handle, *const c_char) -> c_int;
type SetInt = unsafe extern "C" fn(Handle, *const c_char, c_int);
type GetError = unsafe extern "C" fn(Handle, *mut *const c_char) -> c_int;
type NewFilter = unsafe extern "C" fn(Handle, *const c_char) -> Handle;
type SetBool = unsafe extern "C" fn(Handle, *const c_char, bool);
type SetImage = unsafe extern "C" fn(
    Handle,
    *const c_char,
    *mut c_void,
    c_int,
    usize,
    usize,
    usize,
    usize,
    usize,
);

/// A picture of three floats a pixel, row by row, and what it is to the filter.
pub struct Plane<'a> {
    /// `color`, `albedo` or `normal`.
    pub name: &'static CStr,
    /// One value a pixel.
    pub pixels: &'a [[f32; 3]],
}

/// The library, version 2.
pub struct Library {
    loaded: Loaded,
}

impl Library {
    /// Loads the library of this file name, which may have a path.
    pub fn open(name: &OsStr) -> Result<Self, String> {
        // SAFETY: loading runs the library's initialisers. A file of the name that the user gave, or that the
        // system knows as Open Image Denoise, is trusted as the program itself is.
        let loaded = unsafe { Loaded::new(name) }.map_err(|error| {
            let cause = error.source().map(ToString::to_string);
            cause.unwrap_or_else(|| error.to_string())
        })?;
        Ok(Self { loaded })
    }

    /// Filters `planes`, the first of which is the picture, on `threads` threads; the filtered picture and the
    /// library's version, like 20501.
    pub fn filter(
        &self,
        size: UVec2,
        planes: &[Plane],
        threads: usize,
    ) -> Result<(Vec<[f32; 3]>, i32), String> {
        let pixels = size.x as usize * size.y as usize;
        if planes.iter().any(|plane| plane.pixels.len() != pixels) {
            return Err("its pictures are of different sizes".to_owned());
        }
        let mut output = vec![[0.0; 3]; pixels];
        // SAFETY: the symbols have the types that `oidn.h` of version 2 declares, which is checked by asking for
        // functions that version 1 does not have. Handles are used between their creation and their release, both
        // of which are in this function. Each image has `size.x * size.y` packed triples of floats, as checked
        // above, and lives until the filter is released; the library reads the inputs, which nobody writes, and
        // writes `output`, which nobody else uses. The message of an error lives as long as the device.
        unsafe {
            let new_device: Symbol<NewDevice> = self.symbol(c"oidnNewDevice")?;
            let set_int: Symbol<SetInt> = self.symbol(c"oidnSetDeviceInt")?;
            let get_int: Symbol<GetInt> = self.symbol(c"oidnGetDeviceInt")?;
            let commit_device: Symbol<OnHandle> = self.symbol(c"oidnCommitDevice")?;
            let release_device: Symbol<OnHandle> = self.symbol(c"oidnReleaseDevice")?;
            let get_error: Symbol<GetError> = self.symbol(c"oidnGetDeviceError")?;
            let new_filter: Symbol<NewFilter> = self.symbol(c"oidnNewFilter")?;
            let set_image: Symbol<SetImage> = self.symbol(c"oidnSetSharedFilterImage")?;
            let set_bool: Symbol<SetBool> = self.symbol(c"oidnSetFilterBool")?;
            let commit: Symbol<OnHandle> = self.symbol(c"oidnCommitFilter")?;
            let execute: Symbol<OnHandle> = self.symbol(c"oidnExecuteFilter")?;
            let release: Symbol<OnHandle> = self.symbol(c"oidnReleaseFilter")?;

            let device = new_device(CPU);
            if device.is_null() {
                return Err("it does not support this processor".to_owned());
            }
            let threads = c_int::try_from(threads).unwrap_or(c_int::MAX);
            set_int(device, c"numThreads".as_ptr(), threads);
            commit_device(device);
            let version = get_int(device, c"version".as_ptr());
            let filter = new_filter(device, c"RT".as_ptr());
            if !filter.is_null() {
                let (width, height) = (size.x as usize, size.y as usize);
                let image = |name: &CStr, data: *mut c_void| {
                    set_image(filter, name.as_ptr(), data, FLOAT3, width, height, 0, 0, 0);
                };
                for plane in planes {
                    image(plane.name, plane.pixels.as_ptr().cast_mut().cast());
                }
                image(c"output", output.as_mut_ptr().cast());
                set_bool(filter, c"hdr".as_ptr(), true);
                commit(filter);
                execute(filter);
                release(filter);
            }
            let mut message = ptr::null();
            let failure = match get_error(device, &mut message) {
                0 => None,
                code if message.is_null() => Some(format!("error {code}")),
                _ => Some(CStr::from_ptr(message).to_string_lossy().into_owned()),
            };
            release_device(device);
            match failure {
                None => Ok((output, version)),
                Some(failure) => Err(failure),
            }
        }
    }

    /// A function of the library.
    ///
    /// # Safety
    /// `T` must be the type of that function.
    unsafe fn symbol<T>(&self, name: &CStr) -> Result<Symbol<'_, T>, String> {
        // SAFETY: the caller vouches for the type.
        unsafe { self.loaded.get(name.to_bytes_with_nul()) }.map_err(|_| {
            let name = name.to_string_lossy();
            format!("has no function {name}: it is not version 2 of the library")
        })
    }
}
