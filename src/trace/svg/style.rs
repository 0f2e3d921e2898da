//! The style of the drawing, for light and dark display.

/// Plain classes without CSS variables, which some readers of SVG do not support.
pub(super) const STYLE: &str = r##"<style>
text { font-family: "DejaVu Sans Mono", Menlo, Consolas, "Liberation Mono", monospace; font-size: 11px; fill: #1f2733; }
.title { font-family: "DejaVu Sans", "Segoe UI", Helvetica, Arial, sans-serif; font-size: 16px; font-weight: 600; }
.small { font-size: 10px; fill: #677384; }
.words { font-family: "DejaVu Sans", "Segoe UI", Helvetica, Arial, sans-serif; font-size: 11.5px; }
.right { text-anchor: end; }
.middle { text-anchor: middle; }
.paper { fill: #ffffff; }
.band { fill: #f4f6f9; }
.grid { stroke: #dfe4ea; stroke-width: 1; fill: none; }
.axis { stroke: #677384; stroke-width: 1; fill: none; }
.wave { fill: none; stroke-width: 1.6; stroke-linejoin: round; stroke-linecap: round; }
.nck { stroke: #1f5fbf; } .nck-fill { fill: #1f5fbf; fill-opacity: .16; }
.plc { stroke: #c25a00; } .plc-fill { fill: #c25a00; fill-opacity: .18; }
.plant { stroke: #1c7c4a; } .plant-fill { fill: #1c7c4a; fill-opacity: .18; }
.still { stroke: #8a95a3; } .still-fill { fill: #8a95a3; fill-opacity: .18; }
.value { stroke: #7a3fb0; }
.zero { stroke: #b9a3cf; stroke-width: 1; stroke-dasharray: 2 3; fill: none; }
.level { stroke: #b01c30; stroke-width: 1.2; stroke-dasharray: 7 4; fill: none; }
.alarm { fill: #c8283c; fill-opacity: .85; }
.alarm-text { fill: #ffffff; font-weight: 600; font-size: 10px; }
.alarm-name { fill: #b01c30; }
.flag { fill: #1f2733; } .flag-text { fill: #ffffff; font-size: 10px; font-weight: 600; text-anchor: middle; }
.pole { stroke: #1f2733; stroke-opacity: .45; stroke-width: 1; stroke-dasharray: 1 3; fill: none; }
.gap { fill: #ffffff; } .tear { stroke: #8a95a3; stroke-width: 1; fill: none; }
.touch { fill: #000000; fill-opacity: 0; }
@media (prefers-color-scheme: dark) {
text { fill: #dbe2ec; }
.small { fill: #93a0b2; }
.paper, .gap { fill: #12161d; }
.band { fill: #1a2029; }
.grid { stroke: #2b333f; }
.axis { stroke: #93a0b2; }
.nck { stroke: #6ea8ff; } .nck-fill { fill: #6ea8ff; }
.plc { stroke: #f7a04b; } .plc-fill { fill: #f7a04b; }
.plant { stroke: #57c98a; } .plant-fill { fill: #57c98a; }
.still { stroke: #768496; } .still-fill { fill: #768496; }
.value { stroke: #c39af0; }
.zero { stroke: #5d4a78; }
.level { stroke: #ff8b98; }
.alarm { fill: #e0475b; }
.alarm-text { fill: #ffffff; }
.alarm-name { fill: #ff8b98; }
.flag { fill: #dbe2ec; } .flag-text { fill: #12161d; }
.pole { stroke: #dbe2ec; }
.tear { stroke: #768496; }
}
</style>
"##;
