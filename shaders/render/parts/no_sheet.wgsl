// For all views but the fast one.

fn sheet_on(x: f32, y: f32, direction: vec3<f32>) -> Sheet {
    return no_sheet();
}

fn bend_sheet(sheet: Sheet, direction: vec3<f32>) -> Sheet {
    return sheet;
}

fn through_sheet(sheet: Sheet, direction: vec3<f32>, light: vec3<f32>, event: Event) -> vec3<f32> {
    return light;
}
