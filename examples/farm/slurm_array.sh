#!/bin/bash
# A Slurm job array: each task draws its share of the frames on one GPU.
#
#   sbatch --array=0-99 slurm_array.sh fly /shared/my-dem.tif --path /shared/route.gpx --count 25000 -o /shared/frames/%05d.png
#
# hachure takes its share from the array (--shard-from-env). Where it ends with 75 (the device was lost, or Slurm asked it to
# end) the task goes back into the queue, at most three times, and skips what it has drawn. Where the cluster hides the GPUs of
# others (ConstrainDevices) the one that a task sees is number 0; elsewhere add --adapter "$SLURM_JOB_GPUS".
# `hachure merge /shared/frames` says whether all is there.
#SBATCH --job-name=hachure
#SBATCH --array=0-99
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=4
#SBATCH --mem=4G
#SBATCH --gres=gpu:1
#SBATCH --time=01:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --signal=B:TERM@60

# With exec the process of this number is hachure itself: it hears of the end of the time, and finishes its frame.
(exec hachure "$@" --shard-from-env) &
hachure=$!
asked=""
trap 'asked=1; kill -TERM "$hachure"' TERM
while :; do
    wait "$hachure"
    code=$?
    # The signal cut the wait short, not hachure.
    [ -n "$asked" ] && [ "$code" -gt 128 ] || break
    asked=""
done

if [ "$code" -eq 75 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 3 ]; then
    exec scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
fi
exit "$code"
