//! Questions over many operating points.

#[path = "../common/mod.rs"]
mod common;

mod carried;
mod compare;
mod cycle;
mod effort;
mod equations;
mod export;
mod sensitivity;
mod sweep;
mod uncertainty;
mod vary;
