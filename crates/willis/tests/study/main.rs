//! Questions over many operating points.

mod compare;
mod cycle;
mod export;
mod sensitivity;
mod sweep;
mod uncertainty;
