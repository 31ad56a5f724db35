//! The macros that `columns` declares the stores with: structs, names, lanes and lives of all columns from one list.

macro_rules! element {
    (rows) => { Vec<[f32; 4]> };
    (values) => { Vec<f32> };
    (words) => { Vec<u32> };
    ($Type:ident) => { $Type };
}

macro_rules! layout {
    (rows; $($vector:literal)? $(; $($lane:ident $index:literal $unit:literal),+)?) => {
        Element::Rows(&[
            $(Lane { name: "", index: 0, unit: $vector },)?
            $($(Lane { name: stringify!($lane), index: $index, unit: $unit },)+)?
        ])
    };
    (values; $unit:literal) => { Element::Values($unit) };
    (words; $unit:literal) => { Element::Words($unit) };
    ($Type:ident; $unit:literal) => { Element::Other };
}

macro_rules! lane_indices {
    (rows; $($vector:literal)? $(; $($lane:ident $index:literal $unit:literal),+)?) => {
        $($(#[doc = concat!("Unit: ", $unit, ".")] pub const $lane: usize = $index;)+)?
    };
    ($Type:ident; $unit:literal) => {};
}

macro_rules! padding {
    () => {
        Padding::Zero
    };
    ($kind:ident($padding:expr)) => {
        Padding::$kind($padding)
    };
}

macro_rules! is_host {
    () => {
        false
    };
    (host) => {
        true
    };
}

macro_rules! optional_need {
    () => {
        None
    };
    ($need:ident) => {
        Some(Need::$need)
    };
}

macro_rules! columns {
    ($($(#[$store_doc:meta])* $store:ident $row:ident: $Store:ident {
        $(
            $(#[$doc:meta])*
            $Column:ident = $field:ident: $element:ident($($lanes:tt)*) $(padded $kind:ident($padding:expr))?,
            $life:ident $(on $host:ident)? $(, needs $need:ident)?;
        )*
    })*) => {
        $($(#[$store_doc])*
        #[derive(Clone, Debug, Default)]
        pub struct $Store {
            $($(#[$doc])* #[doc = concat!("\n\nElements and units: ", stringify!($element), "(", stringify!($($lanes)*), ").")]
            pub $field: $crate::declaration::element!($element),)*
        })*

        /// Index of the scalars in the rows of columns: `row[lane::fluid::boundary::SHARE]`. A vector comes first.
        pub mod lane {
            $($(#[$store_doc])*
            pub mod $store {
                $(#[doc = concat!("Lanes of [`Column::", stringify!($Column), "`](crate::columns::Column).")]
                pub mod $field { $crate::declaration::lane_indices!($element; $($lanes)*); })*
            })*
        }

        /// Every column; the order is the order of the digest and of saved files.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Column {
            $($($(#[$doc])* $Column,)*)*
        }

        impl Column {
            /// All columns, in order.
            pub const ALL: &'static [Self] = &[$($(Self::$Column,)*)*];

            /// Name, `store.quantity`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $($(Self::$Column => concat!(stringify!($store), ".", stringify!($field)),)*)* }
            }

            /// Name of the buffer on a device, and of the variable of its twins.
            #[must_use]
            pub const fn buffer(self) -> &'static str {
                match self { $($(Self::$Column => concat!(stringify!($row), "_", stringify!($field)),)*)* }
            }

            /// Content of a row, with SI units.
            #[must_use]
            pub const fn element(self) -> Element {
                match self { $($(Self::$Column => $crate::declaration::layout!($element; $($lanes)*),)*)* }
            }

            /// Content of padding rows.
            #[must_use]
            pub const fn padding(self) -> Padding {
                match self { $($(Self::$Column => $crate::declaration::padding!($($kind($padding))?),)*)* }
            }

            /// Lifetime of the content.
            #[must_use]
            pub const fn life(self) -> Life {
                match self { $($(Self::$Column => Life::$life,)*)* }
            }

            /// Whether no device stores it, because twins compute it anew or have it in another form.
            #[must_use]
            pub const fn is_on_host_only(self) -> bool {
                match self { $($(Self::$Column => $crate::declaration::is_host!($($host)?),)*)* }
            }

            /// What a scene must contain for the column to have rows, in addition to those of its store.
            #[must_use]
            pub const fn need(self) -> Option<Need> {
                match self { $($(Self::$Column => $crate::declaration::optional_need!($($need)?),)*)* }
            }

            /// The store that the column belongs to.
            #[must_use]
            pub const fn store(self) -> Store {
                match self { $($(Self::$Column => Store::$Store,)*)* }
            }
        }

        /// Every store.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Store {
            $($(#[$store_doc])* $Store,)*
        }

        /// All stores of a world.
        #[derive(Clone, Debug, Default)]
        pub struct Columns {
            /// Number of rows in use, without padding.
            pub rows: RowCounts,
            $($(#[$store_doc])* pub $store: $Store,)*
        }

        impl Columns {
            /// The data of a column.
            #[must_use]
            pub fn data(&self, column: Column) -> &dyn ColumnData {
                match column { $($(Column::$Column => &self.$store.$field,)*)* }
            }

            /// The data of a column, writable.
            pub fn data_mut(&mut self, column: Column) -> &mut dyn ColumnData {
                match column { $($(Column::$Column => &mut self.$store.$field,)*)* }
            }
        }
    };
}
pub(crate) use {columns, element, is_host, lane_indices, layout, optional_need, padding};
