# SPDX-License-Identifier: Apache-2.0
# Every entry point, in the order in which a frame passes them.
set(VIEWLOOM_SHADERS
  structure/convert_color.comp
  structure/prepare_columns.comp
  structure/measure_depth.comp
  structure/settle_tolerance.comp
  structure/smooth_columns.comp
  structure/fill_apron.comp
  structure/build_facets.comp
  structure/build_blocks.comp
  structure/build_level.comp
  structure/flatten_entries.comp
  structure/color_apron.comp
  trace/average_color.comp
  trace/walk_views.comp
  trace/join_faces.comp
  trace/merge_sources.comp
  trace/reflect.comp
  trace/turn_paths.comp
  trace/walk_paths.comp
  trace/merge_paths.comp
  trace/add_reflections.comp
  trace/blend_samples.comp
  trace/list_met.comp
  trace/gather_lens.comp
  trace/pack_band.comp)
