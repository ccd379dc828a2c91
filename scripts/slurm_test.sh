#!/bin/sh
# A small calibration through a real Slurm of one node on loopback, whose node is drained and taken down mid-run: the
# estimate must be that of the local backend to the last bit. Installs slurm-wlm and munge when they are absent.
#     scripts/slurm_test.sh [BUILD_FOLDER]      as root, on Debian
set -eu
project=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
kerf=$(realpath "${1:-$project/build/release}/kerf")
[ "$(id -u)" = 0 ] || { echo "slurm_test.sh: needs root, to start munged and slurmd" >&2; exit 77; }
if ! command -v slurmd > /dev/null || ! command -v munged > /dev/null; then
  apt-get update -qq && apt-get install -y -qq --no-install-recommends slurm-wlm munge > /dev/null
fi

place=$(mktemp -d /tmp/kerf_slurm.XXXXXX)
chmod 755 "$place"
started=""
finish() {
  status=$?
  for process in $started; do kill "$process" 2> /dev/null || true; done
  [ $status = 0 ] || for log in "$place"/*.log; do echo "--- $log" >&2; tail -n 20 "$log" >&2; done
  rm -rf "$place"
}
trap finish EXIT

# Munge wants a key that is its own, and a socket in a folder that all may enter.
mkdir "$place/munge" "$place/state" "$place/spool"
dd if=/dev/urandom of="$place/munge/key" bs=1024 count=1 status=none
chmod 600 "$place/munge/key"
munged --foreground --force --key-file "$place/munge/key" --socket "$place/munge/socket" \
  --pid-file "$place/munge/pid" --seed-file "$place/munge/seed" --log-file "$place/munge.log" \
  > "$place/munged.log" 2>&1 & started="$started $!"

node=$(hostname -s)
cores=$(nproc)
cat > "$place/slurm.conf" << CONF
ClusterName=kerf
SlurmctldHost=$node(127.0.0.1)
SlurmUser=root
SlurmctldPort=16817
SlurmdPort=16818
AuthType=auth/munge
AuthInfo=socket=$place/munge/socket
CredType=cred/munge
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=sched_interval=1,batch_sched_delay=0
MinJobAge=60
JobRequeue=1
SlurmctldTimeout=30
SlurmdTimeout=30
NodeName=$node NodeAddr=127.0.0.1 CPUs=$cores State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$place/slurm.conf"
sleep 1
slurmctld -D > "$place/slurmctld.log" 2>&1 & started="$started $!"
sleep 2
slurmd -D -N "$node" > "$place/slurmd.log" 2>&1 & started="$started $!"
for _ in $(seq 30); do
  state=$(sinfo -h -o %T 2> /dev/null || true)
  [ "$state" = idle ] && break
  sleep 1
done
[ "$state" = idle ] || { echo "slurm_test.sh: the node did not come up: $state" >&2; exit 1; }

python3 - "$project" "$place" << 'INPUTS'
import pathlib, re, sys
project, place = map(pathlib.Path, sys.argv[1:])
scene = (project / "tests/recovery/twin.toml").read_text()
[job] = re.findall(r'R"\((.*?)\)"', (project / "tests/recovery/twin_scene.hpp").read_text(), re.S)
(place / "scene.toml").write_text(scene)
(place / "job.toml").write_text(job)
(place / "curve.csv").write_text("#: rake = 30 deg\ndepth[mm],Fc[N/mm],Fc_sd[N/mm],Ft[N/mm],Ft_sd[N/mm]\n0.5,10.8,0.3,-4.3,0.2\n")
INPUTS
"$kerf" calibrate "$place/job.toml" -o "$place/local" > /dev/null 2> "$place/local.log"

"$kerf" calibrate "$place/job.toml" -o "$place/slurm" --backend slurm > /dev/null 2> "$place/calibrate.log" &
calibration=$!
runs() { grep -c '"run"' "$place/slurm/journal.jsonl" 2> /dev/null || true; }
for _ in $(seq 600); do [ "$(runs)" -ge 3 ] 2> /dev/null && break; sleep 0.1; done
# Down kills what the node is running; Slurm puts it back into the queue, where it waits for the node.
for _ in $(seq 100); do squeue -h -t R | grep -q . && break; sleep 0.05; done
before=$(runs)
running=$(squeue -h -t R | wc -l)
scontrol update nodename="$node" state=drain reason=test
scontrol update nodename="$node" state=down reason=test
sleep 3
held=$(runs)
queued=$(squeue -h -t PD | wc -l)
scontrol update nodename="$node" state=resume
status=0
wait $calibration || status=$?
[ $status = 0 ] || { echo "slurm_test.sh: the calibration ended with code $status" >&2; exit 1; }

python3 - "$place" "$before" "$held" "$running" "$queued" << 'COMPARE'
import json, pathlib, sys
place = pathlib.Path(sys.argv[1])
local, slurm = (json.loads((place / name / "result.json").read_text()) for name in ("local", "slurm"))
keys = [json.loads(line).get("key") for line in (place / "slurm/journal.jsonl").read_text().splitlines()]
keys = [key for key in keys if key]
print(json.dumps({"runs": slurm["runs"], "when_the_node_went": int(sys.argv[2]), "while_it_was_away": int(sys.argv[3]),
                  "jobs_running_then": int(sys.argv[4]), "jobs_waiting_while_away": int(sys.argv[5]),
                  "repeated": len(keys) - len(set(keys)), "failed": slurm["failed_runs"],
                  "same_estimate": local["parameters"] == slurm["parameters"]}, indent=2))
sys.exit(local["parameters"] != slurm["parameters"] or len(keys) != len(set(keys)) or slurm["runs"] != local["runs"])
COMPARE
