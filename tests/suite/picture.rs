//! Pictures as they are shown, stored and compared.

mod brdf_pages;
mod capture;
mod diff;
mod display;
mod golden;
mod inspector;
mod motion;
mod parts;
mod report;
