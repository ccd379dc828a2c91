#!/usr/bin/env bash
# The virtual experiments of the talk (2013) and of the bench plane (2016), one sweep each, the studies of what accuracy
# costs, and the README's figures of them. About an hour on two cores; resumable: what was simulated before is taken from
# results/experiments.
# Usage: scripts/virtual_experiments.sh [NAME...]     only these
set -euo pipefail
cd "$(dirname "$0")/.."

scenes=data/scenes
wanted=("$@")
is_wanted() { [[ ${#wanted[@]} -eq 0 || " ${wanted[*]} " == *" $1 "* ]]; }
experiment() {  # COMMAND NAME SCENE ARGUMENTS...
  local name=$2
  is_wanted "$name" || return 0
  echo "== $name"
  # 4: some runs were refused, and the table says why.
  build/release/kerf "$1" "$scenes/$3.toml" "${@:4}" -o "results/experiments/$name" || [[ $? -eq 4 ]]
}
sweep() { experiment sweep "$@"; }
study() { experiment study "$@"; }

strength=cohesive.mode_I.strength+cohesive.mode_II.strength
toughness=cohesive.mode_I.toughness+cohesive.mode_II.toughness
depths=cut.depth=0.1,0.2,0.3,0.4,0.5mm

sweep talk verification_45 tool.rake=15,30,45deg cut.depth=0.25,0.5,1,2mm cut.travel=16
sweep talk_hardening verification_hardening_45 tool.rake=15,30,45deg cut.depth=0.25,0.5,1,2mm cut.travel=16
sweep laws verification_45 material.law=j2,hencky
sweep talk_strength verification_45 $strength=15,20,30,40,60,80MPa
sweep talk_toughness verification_45 $toughness=0.5,1,2,3,4kJ/m^2
sweep talk_rake verification_45 tool.rake=10,20,30,40,50,60deg cut.travel=14
sweep talk_friction friction_45 friction.coefficient=0,0.1,0.2,0.3,0.4,0.5,0.6
sweep talk_edge verification_45 cut.depth=0.25,0.5,1mm edge_contact.press_in=0.005,0.01,0.02 edge_contact.edge_radius=1 \
  cut.travel=12 steady_state.not_before=9 resolution.cells_through_chip=6
sweep wood_rl wood_rl --zip $depths window.zone=0.6,1.2,2,2.5,3mm
sweep wood_tl wood_tl_cut bridging.tool=cuts,ignores $depths
sweep plane_m4 plane_breaker friction.coefficient=-,0.3 cut.depth=0.2,0.3,0.4,0.5mm steady_state.not_before=16 cut.travel=28
sweep plane_m12 plane_breaker sole.opening=1.2mm sole.opening_in_depths=- cut.depth=0.2,0.3,0.4,0.5mm steady_state.not_before=16 cut.travel=28
sweep plane_mouth plane_breaker sole.opening_in_depths=12,4,2,1.5 steady_state.not_before=16 cut.travel=28
sweep plane_tip plane_breaker tool.tip_radius=0,0.12,0.24,0.48mm steady_state.not_before=16 cut.travel=28
sweep plane_angle plane_breaker chip_breaker.angle=0,-10,-20deg steady_state.not_before=16 cut.travel=28
sweep plane_bevel plane_breaker tool.bevel=25,35,44deg steady_state.not_before=16 cut.travel=28

# What accuracy costs; the presets were chosen from the polymer's. The wood's is a selection of knobs.
study study_polymer verification_45
study study_wood wood_rl resolution.cells_through_chip=x0.75,x1.25 cut.speed=x2,x4 resolution.courant_number=x1.25 \
  pic_damping.rate=x0,x4 window.ahead+window.behind+window.below+window.above=x0.75 resolution.cell_stretch=3 \
  steady_state.not_before=x0.5 resolution.single_particle_below=0.5,1 preset=draft \
  --reference resolution.cells_through_chip=x1.5

study study_bar vibrating_bar box.cell=x2,x0.5 box.particles_per_cell_side=1,3 box.courant_number=x0.5,x1.5 \
  numerics.shape=uGIMP,linear numerics.transfer=PIC,APIC,XPIC numerics.stress_update=USF,USL,MUSL --reference box.cell=x0.25

if is_wanted study_job; then
  build/release/kerf study data/jobs/wood_tl_r_curve.toml -o results/experiments/study_job
fi

# The same particles as a log, an engine, a rubber band and a glued bar.
if is_wanted veneer; then build/release/kerf simulate "$scenes/veneer.toml" -o results/experiments/veneer.h5; fi
for name in carnot_gas carnot_tungsten carnot_tungsten_plastic rubber_gough incline hertz; do
  is_wanted "$name" || continue
  build/release/kerf simulate "$scenes/$name.toml" -o "results/experiments/$name.json"
done
for stiffness in 1 3 10 30 100 1e3 1e5 1e7 1e9; do
  is_wanted interface_bar || continue
  build/release/kerf simulate "$scenes/interface_bar.toml" --set "interface.normal=$stiffness MPa/mm" \
    -o "results/experiments/interface_bar_$stiffness.json"
done
for angle in 0 15 30 45 60 90; do
  is_wanted laminate || continue
  for stiffness in 30 1e3 5e8; do
    scene=results/experiments/laminate_${angle}_$stiffness
    sed "s/\"60 deg\"/\"$((90 - angle)) deg\"/; s/\"-120 deg\"/\"$((-90 - angle)) deg\"/" "$scenes/laminate.toml" >"$scene.toml"
    build/release/kerf simulate "$scene.toml" --set "interface.normal=$stiffness MPa/mm" \
      --set "interface.tangential=$(python3 -c "print($stiffness / 2)") MPa/mm" -o "$scene.json"
  done
done

scripts/figures.py results/experiments data/figures
