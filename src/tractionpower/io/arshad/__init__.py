"""The files of Arshad et al. (PC train simulator) as printed: configuration, commands, track, consist."""
